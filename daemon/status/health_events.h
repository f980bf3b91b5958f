// HealthEvents: changes of the devices' health, as sentences.
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

  // The changes since the last call: "glove: ok (CyberGlove, 22 sensors)", "tracker: absent
  // (/run/merlin/t: No such file)". A device that is retried with the same result is reported once.
  std::vector<std::string> take(Timestamp now);

 private:
  const shm::DevicesSegment& segment_;
  std::array<std::string, shm::kDevices> last_{};
};

}  // namespace merlin::status
