// WallLoop: draws the wall's frames. The stages of a frame are: input, scene, governor, choice of
// detail, drawing, and delivery to the outputs.
//
// A frame is late if its last pixel reaches the outputs after its deadline, which the FrameClock
// sets. While anything moves, one frame is drawn in each period, with as much detail as the
// governor allows. While nothing moves, finer frames and finally full detail are drawn in slices,
// so that the first frame after motion resumes can begin on time.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/layout.h"
#include "daemon/wall/attendance.h"
#include "daemon/wall/content_turns.h"
#include "daemon/wall/frame_stats.h"
#include "daemon/wall/frame_tracer.h"
#include "daemon/wall/input_feed.h"
#include "daemon/wall/operator_panel.h"
#include "daemon/wall/pace.h"
#include "daemon/wall/show_results.h"
#include "daemon/wall/still_frame.h"
#include "daemon/wall/viewer_place.h"
#include "daemon/wall/wall_publisher.h"
#include "daemon/wall/wall_tuning.h"
#include "render/frame/curtain.h"
#include "render/frame/delivery.h"
#include "render/frame/frame_painter.h"
#include "render/frame/pointer_marker.h"
#include "render/governor/governor.h"
#include "render/out/frame_clock.h"
#include "render/scene/lost_view.h"
#include "render/scene/scene.h"

namespace merlin::wall {

struct WallParts {
  std::vector<ShownContent> contents;  // at least one
  render::scene::Scene& scene;
  render::governor::Governor& governor;
  InputFeed& feed;
  render::frame::Delivery& delivery;  // passes frames to the outputs
  WallSlots slots;                    // receive the statistics
  Clock& clock;
  render::out::FrameClock& frame_clock;            // sets the deadlines of frames
  Attendance& attendance;                          // whether somebody uses the wall
  render::frame::Curtain* curtain = nullptr;       // an overlay of `delivery`; may be null
  render::frame::PointerMarker* marker = nullptr;  // marks where the hand points; may be null
  int fade_frames = 1;                        // number of frames in which a finer frame is faded in
  double return_after_s = 0;                  // SceneSettings::return_after_s; 0: never
  Progress* progress = nullptr;               // stepped once a period; may be null
  ContentSource* replacements = nullptr;      // replaces contents while the wall runs; may be null
  ViewerPlace* viewer = nullptr;              // null: the viewer's head is not tracked
  OperatorPanel* panel = nullptr;             // panel on the operator's tile; may be null
  std::function<void()> on_snapshot = [] {};  // called when a bound input requests a snapshot
  // Returns the number of snapshots written since the start, by inputs and by command.
  std::function<std::uint32_t()> snapshots_written = [] { return 0U; };
  // Called when bound inputs request alignment actions or push the selected corner.
  std::function<void(const AlignInput&)> on_align = [](const AlignInput&) {};
  // Returns whether a test card covers the picture.
  std::function<bool()> shows_testcard = [] { return false; };
  std::size_t first_content = 0;  // index of the content that is shown first
  std::size_t listed = 0;         // number of contents that are shown in turn; 0: all
  // Added to a content's index to get its number in shared memory (WallInteraction::content).
  std::uint32_t first_number = 0;
  // Indexes of the contents of the playlist, in order; empty: all contents in turn.
  std::vector<std::size_t> playlist{};
};

// Thread-bound, except for members whose comment says thread-safe.
class WallLoop {
 public:
  explicit WallLoop(WallParts parts);

  // Draws frames of the contents' initial views, for about a second, to calibrate the governor;
  // they are not shown. Optional; to be called before run().
  void calibrate();

  // Draws frames until `stop`. `first_frame` is called once, after the first frame was passed to
  // all outputs.
  void run(const std::stop_token& stop, const std::function<void()>& first_frame);

  // Requests a combination of these actions; they are executed before the next frame. Thread-safe.
  enum Request : std::uint32_t {
    kResetView = 1,
    kNextMode = 2,
    kNextContent = 4,
    kPreviousContent = 8
  };
  void request(Request what) noexcept { requests_.fetch_or(what); }

  // Shows the content of a place from the next frame on. Nothing happens if there is no such place.
  // Thread-safe.
  void show(std::size_t place) noexcept { place_asked_.store(static_cast<std::int64_t>(place)); }
  // Publishes that request `number` is done: its content was shown (`refused` is empty), or it was
  // refused for the reason `refused`. Thread-safe.
  void finishRequest(std::uint32_t number, const std::string& refused);

  // Moves what the ball moves, in the next frame; the steps of several calls before this frame are
  // added. Thread-safe.
  void move(const render::scene::Push& step);

  // Applies these settings before the next frame. What people have changed by command (the rate, a
  // fixed cost, the playlist switched off) does not change. Thread-safe.
  void tune(WallTuning tuning);

  // See Pace. Applied before the next frame. Thread-safe.
  void hold(std::optional<std::size_t> cost) noexcept { pace_.hold(cost); }
  void setRate(std::optional<double> rate_hz) noexcept { pace_.setRate(rate_hz); }
  // See Pace::limits(). Thread-safe.
  Pace::Limits holdLimits() const noexcept { return pace_.limits(); }

 private:
  Timestamp deadline(std::int64_t k) const { return parts_.frame_clock.deadline(k); }
  const render::content::DetailAxis& detail() const noexcept { return turns_.detail(); }
  render::frame::FramePainter& painter() const noexcept { return turns_.painter(); }

  // Each executes frame or period number k, and returns the number of the next one.
  std::int64_t movingFrame(std::int64_t k, Timestamp began);
  std::int64_t stillPeriod(std::int64_t k);

  void applyRequests();
  void applyTuning();
  render::scene::Push takeStep();
  // Reads the devices' input and moves the scene.
  void readInput(std::int64_t k, Timestamp began);
  WallInput attendedInput(Timestamp now);
  void followPlaylist(const Playlist::Wanted& wanted);
  void followViewer(const WallInput& input, Timestamp now);
  // plannedShare() returns the share of a period planned for the next frame. chooseStep() and
  // stepFor() return the detail step of the next frame, or detail().steps() if there is no time for
  // any frame.
  double plannedShare() const;
  std::size_t chooseStep(std::int64_t k, Timestamp began);
  std::size_t stepFor(Duration available);
  std::int64_t countDeadlines(std::int64_t k, Timestamp finished);
  void finishMoving(const render::frame::DrawTimes& times, Duration present, bool met);
  void refine(std::int64_t k);
  void showFading();
  void present(std::span<std::uint8_t> canvas, bool full_detail,
               std::optional<Timestamp> deadline = std::nullopt);
  void returnToInitialView();
  void showContent();
  void useNavigation();
  bool needsRefining() const;
  void replaceContents();
  void showChosen(const ContentSource::Replacement& chosen);
  void noteRefusal(const ContentSource::Replacement& refused);
  render::frame::PointerMarker::Points pointedAt() const;
  void publish();
  void publishContent(Timestamp now);

  WallParts parts_;
  ContentTurns turns_;
  Pace pace_;
  StillFrame still_;
  WallPublisher publisher_;
  FrameStats stats_;
  FrameTracer tracer_;
  render::scene::SceneView view_;
  render::scene::LostView lost_;
  std::size_t step_ = 0;  // detail step of the last frame
  // Detail step of the last moving frame for which a whole period was available.
  std::optional<std::size_t> moving_step_;
  bool full_detail_ = false;
  bool resuming_ = false;  // the next moving frame is the first after a standstill
  bool held_ = false;      // the wall is black or frozen, so nothing moves the scene
  std::atomic<std::uint32_t> requests_{0};
  // How many of the first moving frames of a new content are still to come.
  std::size_t new_frames_ = 0;
  std::uint64_t frames_ = 0;
  shm::WallStats counted_{};                   // only the fields that the loop sets itself
  std::atomic<std::int64_t> place_asked_{-1};  // -1: none
  std::mutex step_mutex_;
  // Guarded by step_mutex_: the sum of the steps of move() since the last frame, and the results of
  // the requests that are done.
  render::scene::Push step_asked_;
  ShowResults results_;
  std::vector<WallTuning> tunings_;  // guarded by step_mutex_: calls of tune() since the last frame
};

}  // namespace merlin::wall
