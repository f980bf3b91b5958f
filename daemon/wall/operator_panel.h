// OperatorPanel: the panel on the operator's tile (render/panel) in merlind: what pointer and ball
// do with it, what it shows, and which commands it asks for.
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/attendance.h"
#include "daemon/wall/input_feed.h"
#include "daemon/wall/missing_contents.h"
#include "daemon/wall/wall_contents.h"
#include "render/panel/panel_overlay.h"

namespace merlin::wall {

// The functions of the panel that are available with these settings and contents. Projectors, video
// and lamp are not available if the devices belong to another machine.
render::panel::PanelOptions panelOptions(const Settings& settings,
                                         const std::vector<ContentEntry>& contents);

// What is known of the projectors together.
struct ProjectorsSeen {
  std::string power;           // "on", "warming", "mixed"; empty: not known
  std::optional<bool> wanted;  // whether they are on, or are to be
};

// `wanted`: nothing if nobody has switched the projector; it then follows from `power`, if that is
// known.
ProjectorsSeen projectorSeen(std::string power, std::optional<bool> wanted);

// Combines several projectors: the power that they have in common, or "mixed"; `wanted` if all
// agree, else nothing.
ProjectorsSeen together(const std::vector<ProjectorsSeen>& all);

// Thread-safe, except where it says otherwise.
class OperatorPanel final : public render::panel::PanelSource {
 public:
  struct Parts {
    const shm::WallSegment& wall;        // its slots say what the wall shows
    shm::SeqSlot<shm::WallPanel>& slot;  // where the panel's place is published
    std::string devices;                 // name of the devices' segment
    double rate_hz = 0;                  // of the configuration
    float radius_m = 1;                  // of the content
    Attendance& attendance;              // a press is a touch
    const MissingContents& missing;      // of the options' contents
    const Clock& clock;
  };
  // All of `parts` must outlive this object.
  OperatorPanel(render::panel::PanelPlace place, render::panel::PanelOptions options,
                const Parts& parts);

  const render::panel::PanelPlace& place() const noexcept { return place_; }
  const render::panel::PanelOptions& options() const noexcept { return options_; }

  // To be called when the pointer has moved to a pixel of the frame, or away (nothing), or its
  // button has changed. A press while the wall is black only makes it bright again.
  void point(std::optional<render::panel::Point> in_frame, bool pressed);
  // Switches whether the ball operates the panel, from the next frame on.
  void toggleBall();
  // Returns the commands requested since the last call, in their order.
  std::vector<render::panel::Request> takeRequests();
  // Shows for some time why a command was refused.
  void refuse(std::string why);
  // Sets what the role devices reports of the projectors; without a report, the state of those at
  // the GPIO line is read.
  void report(ProjectorsSeen projectors);

  // Once a frame, on the wall's thread, before Attendance::update(): executes what is held, and
  // removes the ball from `input` while the ball operates the panel.
  void update(WallInput& input, Timestamp now);
  // On the wall's thread: replaces the configured rate.
  void configure(double rate_hz) noexcept { parts_.rate_hz = rate_hz; }
  // On the wall's thread: whether actions of the ball's buttons belong to the panel.
  bool takesBall() const noexcept { return view_.by_ball; }
  // On the wall's thread: the view as of the last update().
  const render::panel::PanelView& view() override { return view_; }

 private:
  void readFacts(Timestamp now);
  void readDevices(Timestamp now, render::panel::PanelFacts& facts);
  void useBall(WallInput& input, Timestamp now);
  void addMotion(WallInput& input, Duration elapsed) const;
  void collectRequests();
  void touchBy(std::optional<render::panel::ControlId> pressed);
  void publish(Timestamp now);

  const render::panel::PanelPlace place_;
  const render::panel::PanelOptions options_;
  Parts parts_;

  // Used by the wall's thread only.
  shm::SegmentFollower<shm::DevicesReader> devices_;
  std::optional<Timestamp> read_at_, updated_at_;
  std::optional<bool> published_by_ball_;
  render::panel::PanelView view_;

  std::mutex mutex_;  // guards all below; never held while anything is waited for
  render::panel::PanelInput input_;
  render::panel::PanelFacts facts_;
  std::vector<render::panel::Request> requests_;
  std::optional<ProjectorsSeen> projectors_;
  std::string notice_;
  Timestamp noticed_at_{};
  Attendance::Shown shown_ = Attendance::Shown::kPicture;  // at the last update()
  bool toggled_ = false;    // whether toggleBall() was called since then
  bool swallowed_ = false;  // the press that is held made a black wall bright
};

}  // namespace merlin::wall
