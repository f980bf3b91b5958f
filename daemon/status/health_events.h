// HealthEvents: changes of the devices' health, and the gestures of the hands, as sentences.
#pragma once

#include <cstdint>
#include <limits>
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
        told_(devices_.health.size()),
        last_gestures_(devices_.hands.size()) {}

  // Returns the changes since the last call as events: "glove: ok (CyberGlove, 22 sensors)",
  // "tracker: absent (/run/merlin/t: No such file)". A device that is retried with the same result
  // is reported once. A device that fails repeatedly in the same way and works only for less than
  // shm::kBriefly in between is also reported once; "ok" is then reported only after it has lasted
  // for that time. An event is a fault if the device is not ok or reports a problem, unless its
  // absence is intended (not configured, stopped), which is routine.
  std::vector<Event> take(Timestamp now);
  // Returns an event for each hand that has made a gesture since the last call, about its last
  // gesture: "hand: gesture swipe_left".
  std::vector<Event> takeGestures();

 private:
  // What was reported of a device, and its history.
  struct Told {
    std::string last, fault;  // text of the last event, and of the last fault
    std::int64_t ok_ns = std::numeric_limits<std::int64_t>::min();  // when it last became ok
    bool recurs = false;  // the fault came back after a brief ok
  };
  // Whether the device is ok, but not yet for long enough after a fault that recurs.
  static bool isBrief(Told& told, const DeviceHealth& health, Timestamp now) noexcept;
  static void tellFault(Told& told, const DeviceHealth& health, const std::string& sentence);

  shm::DeviceSlots devices_;
  std::vector<Told> told_;                    // of each device
  std::vector<std::uint32_t> last_gestures_;  // of each hand, GestureState::counter
};

}  // namespace merlin::status
