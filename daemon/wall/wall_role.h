// WallRole: a configuration's wall: model, scene, governor, GL, outputs, on a thread of its own.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/device_feed.h"
#include "daemon/wall/shown_models.h"
#include "daemon/wall/wall_checks.h"
#include "daemon/wall/wall_loop.h"
#include "render/out/output_set.h"

namespace merlin::wall {

class WallRole {
 public:
  // Makes the segments; nothing runs yet. `models`: readModels()'s, at least one. Errors: what is
  // wrong with the wall's settings; kBusy (a living daemon has the segments), kIo.
  static Result<std::unique_ptr<WallRole>> make(const Settings& settings, std::vector<Model> models,
                                                std::uint64_t generation,
                                                const shm::Endpoints& endpoints, ThreadWatch& watch,
                                                Clock& clock);
  ~WallRole();  // stops and joins the wall's thread
  WallRole(const WallRole&) = delete;
  WallRole& operator=(const WallRole&) = delete;

  // Starts the wall's thread. The future holds, once: after the first frame what draws ("EGL,
  // llvmpipe ..."), or why there will be none.
  // `watch` outlives this.
  std::future<Result<std::string>> start();

  // Sets what is done, on the wall's thread, when an input is bound to a snapshot. Before start().
  void onSnapshot(std::function<void()> act) { on_snapshot_ = std::move(act); }

  // From any thread, once the first frame is out.
  void request(WallLoop::Request what);
  void hold(std::optional<std::size_t> triangles);
  void setRate(std::optional<double> rate_hz);

  // Events of models whose files were replaced, since the last call. Thread-safe.
  std::vector<std::string> modelEvents() { return model_watch_.takeEvents(); }

  void beat(Timestamp now) const { segment_.beat(now); }
  // Once a second, from beat()'s thread: both objects in shared memory, by SharedMemory::mend().
  Result<std::string> mend();
  const shm::WallSegment& segment() const { return *segment_; }

 private:
  WallRole(const Settings& settings, std::vector<Model> models, render::TilePlan plan,
           render::Scene scene, shm::SegmentWriter<shm::WallSegment> segment, ThreadWatch& watch,
           Clock& clock);
  Result<Ok> makeOutputs(std::uint64_t generation);
  std::vector<std::unique_ptr<render::Correction>> corrections() const;
  void run(const std::stop_token& stop, Progress& progress);

  Settings settings_;
  std::vector<Model> models_;
  render::TilePlan plan_;
  render::Scene scene_;
  render::Governor governor_;
  shm::SegmentWriter<shm::WallSegment> segment_;
  ThreadWatch& watch_;
  Clock& clock_;
  render::OutputSet outputs_{{}};
  std::function<void()> on_snapshot_ = [] {};
  std::promise<Result<std::string>> ready_;
  std::atomic<WallLoop*> loop_{nullptr};
  ModelWatch model_watch_;  // before the wall's thread, which takes from it
  WatchedThread thread_;
};

}  // namespace merlin::wall
