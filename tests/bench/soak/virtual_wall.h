// The wall's loop on a virtual clock. Real parts: input, turns, scene, governor, ladder, playlist,
// attendance, delivery, the output in shared memory, its picture checks, statistics. Simulated: the
// painter, whose frame times a formula gives.
#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>

#include "config/settings.h"
#include "daemon/shm/segment.h"
#include "daemon/wall/device_feed.h"
#include "daemon/wall/wall_loop.h"
#include "render/content/model_content.h"
#include "render/out/output_set.h"
#include "render/out/picture_checks.h"
#include "tests/bench/soak/virtual_time.h"

namespace merlin::bench {

// Faults that the script causes around the wall.
struct WallFaults {
  double slower = 1;       // factor of all drawing times
  bool unplugged = false;  // the output fails
  bool blackened = false;  // the output shows black instead of the frame that it is sent
};

// Thread-bound.
class VirtualWall {
 public:
  VirtualWall(const Settings& settings, std::uint64_t seed, Fibers& fibers, VirtualClock& clock);
  ~VirtualWall();

  // Starts the fibers of the loop and of the picture checks.
  void start(const std::stop_token& stop);

  // Applies a reload as merlind's role wall does; each flag says whether that part of the settings
  // changed.
  void reload(const Settings& settings, bool rate, bool playlist, bool scene, bool input);

  WallFaults& faults() { return faults_; }
  wall::WallLoop& loop() { return *loop_; }
  wall::Attendance& attendance() { return attendance_; }
  render::out::OutputSet& outputs() { return *outputs_; }
  shm::SegmentWriter<shm::WallSegment>& segment() { return *segment_; }
  shm::WallStats stats() const { return (*segment_)->stats.read().value_or(shm::WallStats{}); }

  static wall::FeedSettings feedSettings(const Settings& settings);

 private:
  class Painter;
  void makeOutputs(const Settings& settings);

  Fibers& fibers_;
  VirtualClock& clock_;
  WallFaults faults_;
  render::lod::Dendrogram model_;
  render::content::ModelDetail detail_;
  render::tiles::TilePlan plan_;
  std::unique_ptr<Painter> painters_[2];
  render::scene::Scene scene_;
  render::governor::Governor governor_;
  wall::DeviceFeed feed_;
  std::optional<shm::SegmentWriter<shm::WallSegment>> segment_;
  std::optional<render::out::OutputSet> outputs_;
  std::optional<render::out::PictureChecks> checks_;
  std::optional<render::frame::Delivery> delivery_;
  render::frame::Curtain curtain_;
  wall::Attendance attendance_;
  render::out::TimerFrameClock frame_clock_;
  std::unique_ptr<wall::WallLoop> loop_;
};

}  // namespace merlin::bench
