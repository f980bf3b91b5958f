// WallFault: determines whether the wall needs attention, for the lamp of the control panel. Reads
// the shared memory of the role wall, which may be another process.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/shm/segment.h"

namespace merlin::devices {

// Thread-bound.
class WallFault {
 public:
  explicit WallFault(const std::string& instance) : wall_(shm::segmentName(instance, "wall")) {}

  // A sentence: why the wall needs attention (an output fails, or shows something else than it was
  // sent, or the wall has not run for kGone). Empty if it does not, or if no wall has run here yet.
  std::string look(Timestamp now);

  static constexpr Duration kGone = std::chrono::seconds(15);  // restarts take less

 private:
  shm::SegmentFollower<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<Timestamp> seen_;  // when it last ran
};

// A sentence about a fault among a wall's outputs; empty if there is none. Pure.
std::string faultAmong(const shm::WallOutputs& outputs);

}  // namespace merlin::devices
