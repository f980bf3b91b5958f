// WallLoop: the wall's frames. design: one frame is input, scene, governor, cut, draw, present.
//
// Frame k begins at t0 + (k-1) x period and is late when its last pixel reaches the sinks after
// t0 + k x period. While anything moves, each period brings a frame of as many triangles as the
// governor allows; while nothing does, the periods are spent on drawing full detail in slices, so
// that the frame that begins after motion resumes begins on time.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "daemon/wall/frame_stats.h"
#include "daemon/wall/input_feed.h"
#include "daemon/wall/painter.h"
#include "render/governor/governor.h"
#include "render/lod/dendrogram.h"
#include "render/out/frame_sink.h"
#include "render/scene/scene.h"

namespace merlin::wall {

struct WallParts {
  const render::Dendrogram& model;
  Painter& painter;
  render::Scene& scene;
  render::Governor& governor;
  InputFeed& feed;
  std::vector<render::FrameSink*> sinks;
  shm::SeqSlot<shm::WallStats>& stats;
  Clock& clock;
};

// Thread-bound but for request() and frames().
class WallLoop {
 public:
  explicit WallLoop(WallParts parts);

  // Until `stop`. `first_frame` is called once, after the first frame reached every sink.
  void run(const std::stop_token& stop, const std::function<void()>& first_frame);

  // From another thread: done before the next frame.
  enum Request : std::uint32_t { kResetView = 1, kNextMode = 2 };
  void request(Request what) noexcept { requests_.fetch_or(what); }

  // Periods that were begun, for the watchdog.
  std::uint64_t periods() const noexcept { return periods_.load(std::memory_order_relaxed); }

 private:
  Timestamp tick(std::int64_t k) const { return start_ + k * period_; }
  // Each returns the number of the next tick.
  std::int64_t movingFrame(std::int64_t k, Timestamp began);
  std::int64_t stillPeriod(std::int64_t k);
  void obeyRequests();
  void present(bool full_detail);
  void publishStats(Timestamp now);

  WallParts p_;
  Duration period_;
  Timestamp start_{};
  FrameStats stats_;
  render::SceneView view_;
  std::size_t level_ = 0;
  bool refining_ = false, full_detail_ = false;
  bool resuming_ = false;  // the next frame is the first after a standstill
  Timestamp still_since_{};
  std::uint64_t frames_ = 0;
  shm::WallStats out_{};
  std::atomic<std::uint32_t> requests_{0};
  std::atomic<std::uint64_t> periods_{0};
};

}  // namespace merlin::wall
