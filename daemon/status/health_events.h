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

  // The changes since the last call: "glove: ok (CyberGlove, 22 sensors)", "tracker: absent
  // (/run/merlin/t: No such file)". A device that is retried with the same result is reported once.
  // So is a device that fails in the same way again and again and works only briefly in between
  // (shm::kBriefly): "ok" is then reported only after it has lasted for that time. An event is a
  // fault if the device is not ok, or reports a problem.
  std::vector<Event> take(Timestamp now);
  // The last gesture of each hand since the last call: "hand: gesture swipe_left".
  std::vector<Event> takeGestures();

 private:
  // What was reported of a device, and its history.
  struct Told {
    std::string last, fault;  // the last event, and the last one of a device that did not work
    std::int64_t ok_ns = std::numeric_limits<std::int64_t>::min();  // since when it was ok last
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
