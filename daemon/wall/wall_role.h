// WallRole: the wall that a configuration describes: models, scene, governor, OpenGL and outputs,
// run on its own thread.
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

// What changed in the settings while the wall is drawn.
struct WallChanges {
  bool rate = false, playlist = false, scene = false, input = false, corrections = false;
};

// The renderer that draws the wall, for the status.
struct RendererReport {
  render::gl::RendererInfo info{};
  int contexts = 1;
  bool asynchronous = false;  // how pixels are read back
  bool corrects = false;      // whether the renderer computes the corrections, not the CPU
  // Why the renderer does not compute (all of) them although it is set to; empty: no fault.
  std::string correction_fault{};
  // How the signals that the renderer corrects come to displays; not drawn if it corrects none.
  ScanOutReport scan_out{};
};

class WallRole {
 public:
  // Creates the shared-memory segments; the wall's thread does not run yet. `contents`: from
  // readContents(), at least one. `keeper`: the state that people change at run time; it, `watch`
  // and `clock` must outlive this object. Errors: kBusy (a running daemon owns the segments), kIo,
  // and errors in the wall's settings.
  static Result<std::unique_ptr<WallRole>> make(const Settings& settings,
                                                std::vector<WallContent> contents,
                                                std::uint64_t generation,
                                                const shm::Endpoints& endpoints,
                                                state::StateKeeper& keeper, KeptFiles& kept_files,
                                                ThreadWatch& watch, Clock& clock);
  ~WallRole();  // stops and joins the wall's thread
  WallRole(const WallRole&) = delete;
  WallRole& operator=(const WallRole&) = delete;

  // Starts the wall's thread. The future is set once: after the first frame to the name of the
  // OpenGL renderer ("EGL, llvmpipe ..."), or to the error if drawing cannot start.
  std::future<Result<std::string>> start();

  // Returns nothing before the renderer is chosen, on the wall's thread. Thread-safe.
  std::optional<RendererReport> renderer() const;

  // Sets the functions called on the wall's thread: `act` when a bound input requests a snapshot,
  // `written` for the number of those that were written. To be called before start().
  void onSnapshot(std::function<void()> act, std::function<std::uint32_t()> written) {
    on_snapshot_ = std::move(act);
    snapshots_written_ = std::move(written);
  }

  // Sets the functions that outputs of kind window call, on their own threads, for the person at
  // them. To be called before start().
  void onWindow(render::out::WindowActs acts) { outputs_->onWindow(std::move(acts)); }

  // Applies these settings before the wall's next frame, without closing anything. `changes`: the
  // groups that differ. REQUIRES: the first frame was shown; all else in `settings` is as before.
  void reload(const Settings& settings, const WallChanges& changes);

  // Thread-safe; these four are ignored before the wall's loop runs.
  void request(WallLoop::Request what);
  // Moves what the ball moves by `way_radii` times the model's radius and turns it by `turn_deg`.
  void move(const Eigen::Vector3f& way_radii, const Eigen::Vector3f& turn_deg);
  void hold(std::optional<std::size_t> cost);
  void setRate(std::optional<double> rate_hz);
  // Thread-safe: the range of costs that hold() may fix for the content that is shown; nothing
  // before the loop runs.
  std::optional<Pace::Limits> holdLimits() const;
  // For its thread-safe members.
  CorrectedOutputs& outputs() { return *outputs_; }
  // What people have asked to be shown; for its thread-safe members.
  ContentRequests& contents() { return requests_; }
  // For its thread-safe members; null if there is no panel on the operator's tile.
  OperatorPanel* panel() { return operator_tile_.panel(); }
  // For its thread-safe members.
  Attendance& attendance() { return attendance_; }

  // To be called ten times a second: saves in the state which content is shown, removes shared
  // memory of signals that nobody requests any more, publishes the notice, and keeps the playlist
  // from beginning while a test card is shown.
  void tend(Timestamp now);

  // Returns the events of the viewer's tracked head since the last call. Thread-safe.
  std::vector<Event> viewerEvents();

  // Shows a sentence over the picture for a few seconds. Errors: those of Notice::show().
  // Thread-safe.
  Result<Ok> notice(const std::string& text) { return notice_.show(text); }

  // Shows a sentence on the operator's tile for a minute. Thread-safe.
  void tell(std::string sentence) { board_.add(clock_.now(), std::move(sentence)); }

  // Returns the events of replaced, unreadable and missing files since the last call. Thread-safe.
  std::vector<Event> contentEvents();

  void writeHeartbeat(Timestamp now) const { segment_.writeHeartbeat(now); }
  // To be called once a second on the thread that calls writeHeartbeat(): restores the wall's
  // segment and the outputs' shared memory by SharedMemory::mend().
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
  const std::vector<ContentEntry> entries_;  // of contents_
  MissingContents missing_;                  // of entries_
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
  bool told_empty_ = false;        // the same
  ScanOutReport told_scan_out_{};  // the same
  render::testcard::CardOverlay cards_;
  MessageBoard board_;
  Attendance attendance_;
  OperatorTile operator_tile_;
  Notice notice_;
  render::frame::Curtain curtain_;
  std::unique_ptr<CorrectedOutputs> outputs_;
  std::optional<render::frame::Delivery> delivery_;  // has the corrections while the wall runs
  std::function<void()> on_snapshot_ = [] {};
  std::function<std::uint32_t()> snapshots_written_ = [] { return 0U; };
  std::mutex viewer_events_mutex_;
  std::vector<Event> viewer_events_;
  std::promise<Result<std::string>> ready_;
  std::atomic<WallLoop*> loop_{nullptr};
  // Declared before thread_, which uses all three.
  ModelWatch model_watch_;
  render::content::TileLoader tiles_;
  ContentRequests requests_;
  WatchedThread thread_;
};

}  // namespace merlin::wall
