// HealthEvents: changes of the devices' health, and the gestures of the hands, as sentences.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/shm/device_slots.h"

namespace merlin::status {

// Thread-bound.
class HealthEvents {
 public:
  explicit HealthEvents(shm::DeviceSlots devices)
      : devices_(std::move(devices)),
        last_(devices_.health.size()),
        last_gestures_(devices_.hands.size()) {}

  // The changes since the last call: "glove: ok (CyberGlove, 22 sensors)", "tracker: absent
  // (/run/merlin/t: No such file)". A device that is retried with the same result is reported once.
  // Faults are those of a device that is not ok, or complains.
  std::vector<Event> take(Timestamp now);
  // The gestures since the last call, of each hand the last one: "hand: gesture swipe_left".
  std::vector<Event> takeGestures();

 private:
  shm::DeviceSlots devices_;
  std::vector<std::string> last_;             // the last event of each device
  std::vector<std::uint32_t> last_gestures_;  // of each hand, GestureState::counter
};

}  // namespace merlin::status
