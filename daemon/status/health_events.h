// HealthEvents: changes of the devices' health, as sentences.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/shm/device_slots.h"

namespace merlin::status {

// Thread-bound.
class HealthEvents {
 public:
  explicit HealthEvents(shm::DeviceSlots devices)
      : devices_(std::move(devices)), last_(devices_.health.size()) {}

  // The changes since the last call: "glove: ok (CyberGlove, 22 sensors)", "tracker: absent
  // (/run/merlin/t: No such file)". A device that is retried with the same result is reported once.
  std::vector<std::string> take(Timestamp now);

 private:
  shm::DeviceSlots devices_;
  std::vector<std::string> last_;  // the last event of each device
};

}  // namespace merlin::status
