// OperatorPanel: connects the panel on the operator's tile (render/panel) to merlind: it passes
// pointer and ball to the panel, collects the facts that the panel shows, and returns the commands
// that a person requests with it.
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

// Returns the functions of the panel that are available with these settings and contents.
// Projectors, video and lamp are not available if the wall uses the devices of another machine.
render::panel::PanelOptions panelOptions(const Settings& settings,
                                         const std::vector<ContentEntry>& contents);

// What is known of one projector, or of several together.
struct ProjectorsSeen {
  std::string power;           // "on", "warming", "unknown", "mixed" ...; empty: no projector
  std::optional<bool> wanted;  // whether they are, or will be, on; nothing: not known
};

// Returns what is known of one projector. `wanted`: nothing if nobody has switched it; then
// `wanted` of the result follows from `power`, unless that is "unknown".
ProjectorsSeen projectorSeen(std::string power, std::optional<bool> wanted);

// Combines several projectors. `power`: that of all of them if it is the same, else "mixed".
// `wanted`: that of all of them if they agree, else nothing.
ProjectorsSeen together(const std::vector<ProjectorsSeen>& all);

// Thread-safe, except for members that a comment assigns to the wall's thread.
class OperatorPanel final : public render::panel::PanelSource {
 public:
  struct Parts {
    const shm::WallSegment& wall;        // source of the facts about the wall
    shm::SeqSlot<shm::WallPanel>& slot;  // receives the panel's place when it changes
    std::string devices;                 // name of the devices' segment
    double rate_hz = 0;                  // configured frame rate
    float radius_m = 1;                  // radius of the content
    Attendance& attendance;              // a press counts as a touch
    const MissingContents& missing;      // which of options().contents are missing
    const Clock& clock;
  };
  // What `parts` refers to must outlive this object.
  OperatorPanel(render::panel::PanelPlace place, render::panel::PanelOptions options,
                const Parts& parts);

  const render::panel::PanelPlace& place() const noexcept { return place_; }
  const render::panel::PanelOptions& options() const noexcept { return options_; }

  // To be called when the pointer has moved to a pixel of the frame or has left it (nothing), or
  // when the pointer's button was pressed or released. A press while the wall is black only shows
  // the picture again.
  void point(std::optional<render::panel::Point> in_frame, bool pressed);
  // Toggles whether the ball operates the panel, from the next frame on.
  void toggleBall();
  // Returns the commands requested since the last call, in the order of the requests.
  std::vector<render::panel::Request> takeRequests();
  // Shows for 15 s why a command was refused.
  void refuse(std::string why);
  // Sets what the role `devices` reports about the projectors. If this is never called, the panel
  // shows the state of the projectors at the GPIO line, read from shared memory.
  void report(ProjectorsSeen projectors);

  // To be called once a frame on the wall's thread, before Attendance::update(). Updates view().
  // Adds the motion of the control that is held to `input`, and removes the ball's motion from
  // `input` while the ball operates the panel.
  void update(WallInput& input, Timestamp now);
  // Replaces the configured rate. For the wall's thread.
  void configure(double rate_hz) noexcept { parts_.rate_hz = rate_hz; }
  // Whether the ball operates the panel, so that its buttons trigger no actions. For the wall's
  // thread.
  bool takesBall() const noexcept { return view_.by_ball; }
  // Returns the view as of the last update(). For the wall's thread.
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

  std::mutex mutex_;  // guards all members below; never held during a wait
  render::panel::PanelInput input_;
  render::panel::PanelFacts facts_;
  std::vector<render::panel::Request> requests_;
  std::optional<ProjectorsSeen> projectors_;
  std::string notice_;
  Timestamp noticed_at_{};
  Attendance::Shown shown_ = Attendance::Shown::kPicture;  // as of the last update()
  bool toggled_ = false;    // toggleBall() is to be applied by the next update()
  bool swallowed_ = false;  // the present press has ended black and does nothing else
};

}  // namespace merlin::wall
