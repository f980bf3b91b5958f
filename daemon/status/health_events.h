// HealthEvents: what changed of the devices since the last look, as sentences and as event
// documents.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"

namespace merlin::status {

// Thread-bound.
class HealthEvents {
 public:
  explicit HealthEvents(const shm::DevicesSegment& segment) : segment_(segment) {}

  // "glove: ok (CyberGlove, 22 sensors)", "tracker: absent (/run/merlin/t: No such file)"; a device
  // that only tries again and again is told once.
  std::vector<std::string> take(Timestamp now);

 private:
  const shm::DevicesSegment& segment_;
  std::array<std::string, shm::kDevices> last_{};
};

}  // namespace merlin::status
