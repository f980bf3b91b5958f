// WallFault: determines whether the wall needs attention, for the lamp of the control panel. Reads
// the shared memory of the role `wall`, which may be another process.
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

  // Returns a sentence about why the wall needs attention: an output fails, or shows something else
  // than it was sent, or the wall has not run for kGone. Empty if it needs none, or if no wall has
  // run since this object was made.
  std::string look(Timestamp now);

  static constexpr Duration kGone = std::chrono::seconds(15);  // longer than a restart takes

 private:
  shm::SegmentFollower<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<Timestamp> seen_;  // when the wall last ran
};

// Returns a sentence about the first output of a wall that has a fault; empty if none has. Pure.
std::string faultAmong(const shm::WallOutputs& outputs);

}  // namespace merlin::devices
