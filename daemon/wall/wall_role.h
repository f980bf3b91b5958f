// WallRole: owns and runs the wall that a configuration describes: contents, scene, governor,
// OpenGL and outputs. It draws on a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/kept_files.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/segment.h"
#include "daemon/state/state_keeper.h"
#include "daemon/wall/attendance.h"
#include "daemon/wall/content_requests.h"
#include "daemon/wall/corrected_outputs.h"
#include "daemon/wall/device_feed.h"
#include "daemon/wall/last_content.h"
#include "daemon/wall/message_board.h"
#include "daemon/wall/notice.h"
#include "daemon/wall/operator_tile.h"
#include "daemon/wall/shown_models.h"
#include "daemon/wall/wall_checks.h"
#include "daemon/wall/wall_loop.h"
#include "render/testcard/card_overlay.h"

namespace merlin::wall {

// Which groups of the wall's settings differ after a reload.
struct WallChanges {
  bool rate = false, playlist = false, scene = false, input = false, corrections = false;
};

// Information about the renderer that draws the wall, for the status.
struct RendererReport {
  render::gl::RendererInfo info{};
  int contexts = 1;
  bool asynchronous = false;  // whether pixels are read back asynchronously
  bool corrects = false;      // whether the GPU, not the CPU, computes the corrections
  // Why the GPU does not compute all corrections although it should; empty: no fault.
  std::string correction_fault{};
  // How the signals that the GPU corrects get to the displays; the default value if it corrects
  // none.
  ScanOutReport scan_out{};
};

class WallRole {
 public:
  // Creates the shared memory and opens the outputs; does not start the wall's thread. `contents`:
  // from readContents(), at least one. `generation`: shm::newGeneration(). `keeper`, `kept_files`,
  // `watch` and `clock` must outlive this object. Errors: kBusy (a running daemon owns the
  // segments), kIo, errors in the wall's settings, and those of CorrectedOutputs::make().
  static Result<std::unique_ptr<WallRole>> make(const Settings& settings,
                                                std::vector<WallContent> contents,
                                                std::uint64_t generation,
                                                const shm::Endpoints& endpoints,
                                                state::StateKeeper& keeper, KeptFiles& kept_files,
                                                ThreadWatch& watch, Clock& clock);
  ~WallRole();  // stops and joins the wall's thread
  WallRole(const WallRole&) = delete;
  WallRole& operator=(const WallRole&) = delete;

  // Starts the wall's thread. The future receives the name of the OpenGL renderer ("EGL, llvmpipe
  // ...") after the first frame, or an error if drawing cannot start.
  std::future<Result<std::string>> start();

  // Returns information about the renderer; nothing until the wall's thread has chosen the
  // renderer. Thread-safe.
  std::optional<RendererReport> renderer() const;

  // Sets two functions that the wall's thread calls: `act`, when a bound input requests a snapshot,
  // and `written`, which returns the number of snapshots written so far. To be called before
  // start().
  void onSnapshot(std::function<void()> act, std::function<std::uint32_t()> written) {
    on_snapshot_ = std::move(act);
    snapshots_written_ = std::move(written);
  }

  // Sets the functions that outputs of kind window call, on their own threads, to execute what the
  // person at the window does. To be called before start().
  void onWindow(render::out::WindowActs acts) { outputs_->onWindow(std::move(acts)); }

  // Applies these settings from the wall's next frame on, without closing any output. `changes`:
  // the groups that differ from the present settings. REQUIRES: the first frame was shown; all
  // other settings are the same as before.
  void reload(const Settings& settings, const WallChanges& changes);

  // request(), move(), hold() and setRate() do nothing while the wall's loop does not run. All four
  // are thread-safe.
  void request(WallLoop::Request what);
  // Moves what the ball moves by `way_radii` (right, up, towards the viewer), in multiples of the
  // model's radius, and turns it by `turn_deg` about these axes.
  void move(const Eigen::Vector3f& way_radii, const Eigen::Vector3f& turn_deg);
  void hold(std::optional<std::size_t> cost);
  void setRate(std::optional<double> rate_hz);
  // Returns the range of costs that hold() may fix for the content that is shown; nothing while the
  // loop does not run. Thread-safe.
  std::optional<Pace::Limits> holdLimits() const;
  // For its thread-safe members.
  CorrectedOutputs& outputs() { return *outputs_; }
  // Executes requests to show a content. For its thread-safe members.
  ContentRequests& contents() { return requests_; }
  // Null if there is no panel on the operator's tile. For its thread-safe members.
  OperatorPanel* panel() { return operator_tile_.panel(); }
  // For its thread-safe members.
  Attendance& attendance() { return attendance_; }

  // Does the regular work outside the wall's thread: saves in the state which content is shown,
  // removes the shared memory of signals that nobody requests any more, publishes the notice, shows
  // a notice while no content can be read, and keeps the playlist from beginning while a test card
  // is shown. To be called ten times a second, always by the same thread.
  void tend(Timestamp now);

  // Returns the events about the viewer's tracked head since the last call. Thread-safe.
  std::vector<Event> viewerEvents();

  // Shows a sentence over the picture for a few seconds; "off" ends it. Errors: those of
  // Notice::show(). Thread-safe.
  Result<Ok> notice(const std::string& text) { return notice_.show(text); }

  // Adds a message that the operator's tile shows for about a minute. Thread-safe.
  void tell(std::string sentence) { board_.add(clock_.now(), std::move(sentence)); }

  // Returns the events about replaced, unreadable and missing files since the last call.
  // Thread-safe.
  std::vector<Event> contentEvents();

  void writeHeartbeat(Timestamp now) const { segment_.writeHeartbeat(now); }
  // Restores the wall's segment and the outputs' shared memory if another process has removed them:
  // see SharedMemory::mend(). To be called once a second on the thread that calls writeHeartbeat().
  Result<std::string> mend();
  const shm::WallSegment& segment() const { return *segment_; }

 private:
  WallRole(const Settings& settings, std::vector<WallContent> contents,
           render::tiles::TilePlan plan, render::scene::Scene scene,
           shm::SegmentWriter<shm::WallSegment> segment, state::StateKeeper& keeper,
           ThreadWatch& watch, Clock& clock);
  std::uint32_t firstNumber() const noexcept;
  void tellIfEmpty(Timestamp now);
  void tellScanOut();
  void run(const std::stop_token& stop, Progress& progress);
  void addOwn(WallParts& parts);
  void beginCorrecting(const render::frame::DrawContexts& contexts);
  std::optional<ViewerPlace> makeViewerPlace();
  static FeedSettings feedSettings(const Settings& settings);
  std::vector<render::frame::Overlay*> overlaysWith(render::frame::PointerMarker& marker);

  Settings settings_;  // `wall` is drawnWall() of the configured one
  std::vector<WallContent> contents_;
  const std::vector<ContentEntry> entries_;  // entries of contents_
  MissingContents missing_;                  // which of entries_ are missing
  render::tiles::TilePlan plan_;
  render::scene::Scene scene_;
  render::governor::Governor governor_;
  shm::SegmentWriter<shm::WallSegment> segment_;
  state::StateKeeper& keeper_;
  ThreadWatch& watch_;
  Clock& clock_;
  mutable std::mutex renderer_mutex_;
  std::optional<RendererReport> renderer_;
  LastContent last_content_;       // used by the thread of tend() only
  bool told_empty_ = false;        // used by the thread of tend() only
  ScanOutReport told_scan_out_{};  // used by the thread of tend() only
  render::testcard::CardOverlay cards_;
  MessageBoard board_;
  Attendance attendance_;
  OperatorTile operator_tile_;
  Notice notice_;
  render::frame::Curtain curtain_;
  std::unique_ptr<CorrectedOutputs> outputs_;
  std::optional<render::frame::Delivery> delivery_;  // owns the corrections while the wall runs
  std::function<void()> on_snapshot_ = [] {};
  std::function<std::uint32_t()> snapshots_written_ = [] { return 0U; };
  std::mutex viewer_events_mutex_;
  std::vector<Event> viewer_events_;
  std::promise<Result<std::string>> ready_;
  std::atomic<WallLoop*> loop_{nullptr};
  // Declared before thread_, which uses these three.
  ModelWatch model_watch_;
  render::content::TileLoader tiles_;
  ContentRequests requests_;
  WatchedThread thread_;
};

}  // namespace merlin::wall
