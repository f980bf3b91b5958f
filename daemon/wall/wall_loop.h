// WallLoop: the wall's frames. design: one frame is input, scene, governor, cut, draw, present.
//
// A frame is late when its last pixel reaches the sinks after its deadline, as the FrameClock says.
// While anything moves, each period brings a frame of as much detail as the
// governor allows; while nothing does, the periods are spent on drawing finer pictures and then
// full detail in slices, so that the frame that begins after motion resumes begins on time. Where
// not even the fewest triangles come in time, tiles are drawn at half their size, and then the rate
// is halved (render/governor/ladder.h).
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/layout.h"
#include "daemon/wall/frame_stats.h"
#include "daemon/wall/frame_tracer.h"
#include "daemon/wall/input_feed.h"
#include "render/content/content.h"
#include "render/frame/delivery.h"
#include "render/frame/fade.h"
#include "render/frame/frame_painter.h"
#include "render/frame/pointer_marker.h"
#include "render/governor/governor.h"
#include "render/governor/ladder.h"
#include "render/out/frame_clock.h"
#include "render/scene/lost_view.h"
#include "render/scene/scene.h"

namespace merlin::wall {

// A content as the loop sees it: how finely it can be drawn, and who draws it.
struct ShownContent {
  const render::DetailAxis* detail;
  render::FramePainter* painter;
};

// Port: contents that take the places of others while the wall runs. Implemented by ShownModels.
class ContentSource {
 public:
  virtual ~ContentSource() = default;
  struct Replacement {
    std::size_t place;
    ShownContent content;
  };
  // Asked between frames. What stood in that place is not used again. `T_eye_model`: the view that
  // it will be seen from. May take long where nothing moves.
  virtual std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_model) = 0;
};

struct WallParts {
  std::vector<ShownContent> contents;  // one at least; the first one is shown first
  render::Scene& scene;
  render::Governor& governor;
  InputFeed& feed;
  render::Delivery& delivery;  // where frames go
  shm::SeqSlot<shm::WallStats>& stats;
  Clock& clock;
  render::FrameClock& frame_clock;                 // when a frame has to be there
  shm::Channel<shm::FrameTrace>* trace = nullptr;  // where steps are told; may be none
  render::PointerMarker* marker = nullptr;         // who marks where the hand points; the same
  shm::SeqSlot<shm::WallInteraction>* interaction = nullptr;  // where that is told
  shm::SeqSlot<shm::WallOutputs>* outputs = nullptr;  // where it is told how the outputs fare
  int fade_frames = 1;                                // in which a finer picture replaces a coarser
  double return_after_s = 0;                          // of a view that shows nothing; 0: never
  Progress* progress = nullptr;                       // stepped once a period; may be none
  ContentSource* replacements = nullptr;              // the same
  std::function<void()> on_snapshot = [] {};  // a person asks for the newest frame as a file
};

// Thread-bound but for request(), hold() and setRate().
class WallLoop {
 public:
  explicit WallLoop(WallParts parts);

  // Draws a dozen frames of different sizes of the first content, a second at most, and tells the
  // governor what they cost; a few of each other one. Nothing is presented. Before run(), or not at
  // all.
  void calibrate();

  // Until `stop`. `first_frame` is called once, after the first frame reached every sink.
  void run(const std::stop_token& stop, const std::function<void()>& first_frame);

  // From another thread: done before the next frame.
  enum Request : std::uint32_t { kResetView = 1, kNextMode = 2, kNextContent = 4 };
  void request(Request what) noexcept { requests_.fetch_or(what); }

  // From another thread, before the next frame: so many triangles while it moves, or as the
  // governor says; this rate, REQUIRES: > 0, or the configured one.
  void hold(std::optional<std::size_t> triangles) noexcept;
  void setRate(std::optional<double> rate_hz) noexcept;

 private:
  Timestamp deadline(std::int64_t k) const { return p_.frame_clock.deadline(k); }
  // Each returns the number of the next frame.
  std::int64_t movingFrame(std::int64_t k, Timestamp began);
  std::int64_t stillPeriod(std::int64_t k);
  // Reads the devices, moves the scene.
  void look(std::int64_t k, Timestamp began);
  render::DrawTimes draw(std::size_t step, Timestamp until);
  std::size_t chooseStep(Duration available);  // detail().steps() where there is no time for any
  std::int64_t countDeadlines(std::int64_t k, Timestamp finished);
  void finishMoving(const render::DrawTimes& times, Duration present, bool met);
  void climb(bool late, bool least);
  bool higherFits() const;
  int scale() const noexcept { return ladder_.rung() > 0 ? 2 : 1; }
  int rateDivisor() const noexcept { return 1 << std::max(ladder_.rung() - 1, 0); }
  void beginRefining();
  void showRefined();
  void fadeOn();
  void obeyRequests();
  bool applyRate();
  void present(std::span<std::uint8_t> canvas, bool full_detail,
               std::optional<Timestamp> deadline = std::nullopt);
  void publishTrace(Timestamp now);
  void publishInteraction(Timestamp now);
  void publishOutputs(Timestamp now);
  std::optional<Eigen::Vector3f> pointedAt() const;
  void publishStats(Timestamp now);
  void paceStats(Timestamp now);
  const render::DetailAxis& detail() const noexcept { return *p_.contents[content_].detail; }
  render::FramePainter& painter() const noexcept { return *p_.contents[content_].painter; }
  void measureHome();
  void expectHome();
  void returnHome();
  void nextContent(std::uint32_t times);
  void showContent(std::size_t content);
  void replaceContents();

  WallParts p_;
  double asked_hz_, configured_hz_;
  Duration period_;
  FrameStats stats_;
  FrameTracer tracer_;
  render::SceneView view_;
  render::LostView lost_;
  // The first rung of the wall's halves the picture's size, each further one the rate.
  render::Ladder ladder_{3}, operator_ladder_{1};
  std::size_t step_ = 0;
  std::optional<std::size_t> moving_step_;  // of the last moving frame that had a whole period
  bool refining_ = false, full_detail_ = false;
  std::size_t refined_step_ = 0;
  render::Fade fade_;              // to what was refined last
  bool first_refinement_ = false;  // the next one is, since the standstill
  bool resuming_ = false;          // the next frame is the first after a standstill
  Timestamp still_since_{};
  std::uint64_t frames_ = 0;
  // Cost of a content's start view: drawing `cost` units of detail took drawing_s seconds; 0: not
  // known.
  struct Home {
    std::size_t cost = 0;
    double drawing_s = 0;
  };
  std::vector<Home> homes_;          // by content
  std::size_t content_ = 0;          // that is shown
  std::uint32_t next_contents_ = 0;  // times that another content was asked for, since the start
  std::uint32_t snapshots_ = 0;      // likewise snapshots
  shm::WallStats out_{};
  std::atomic<std::int64_t> hold_{-1};  // triangles; -1: as the governor says
  std::atomic<double> rate_hz_{0};      // 0: as configured
  std::atomic<std::uint32_t> requests_{0};
};

}  // namespace merlin::wall
