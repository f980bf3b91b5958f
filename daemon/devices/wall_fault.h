// WallFault: whether the wall needs somebody, for the lamp of the control panel: read from the
// shared memory of the role wall, which may be another process.
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

  // Why the wall needs somebody, a sentence: an output fails, or shows something else than it was
  // sent, or the wall has not run for kGone. Empty: it does not, or none has run here yet.
  std::string look(Timestamp now);

  static constexpr Duration kGone = std::chrono::seconds(15);  // restarts take less

 private:
  shm::SegmentFollower<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<Timestamp> seen_;  // when it last ran
};

// The fault among a wall's outputs, a sentence; empty: there is none. Pure.
std::string faultAmong(const shm::WallOutputs& outputs);

}  // namespace merlin::devices
