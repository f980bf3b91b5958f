// DeviceSlots: pointers to the slots of the devices' segment that a reader uses. Each slot is found
// by its name in the segment's table of fields, once, when the segment is opened.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/shm/layout.h"
#include "daemon/shm/slot_table.h"

namespace merlin::shm {

// Pointers to the slots of a devices' segment, which must stay mapped as long as they are used.
// Reentrant.
struct DeviceSlots {
  struct Health {
    std::string device;  // "glove"
    const SeqSlot<DeviceHealth>* slot;
  };
  struct Glove {
    std::string name;
    const SeqSlot<DeviceHealth>* health;
    const Channel<GloveSample>* samples;
    const Channel<PostureSample>* posture;
    const SeqSlot<PostureState>* posture_state;
  };
  struct Tracker {
    std::string name;
    const SeqSlot<DeviceHealth>* health;
    std::array<const Channel<TrackerSample>*, kStations> stations;  // index: station - 1
    const SeqSlot<TrackerFrames>* frames;
  };
  struct Ball {
    std::string name;
    const SeqSlot<DeviceHealth>* health;
    const Channel<BallSample>* samples;
  };
  struct Touch {
    std::string name;
    const SeqSlot<DeviceHealth>* health;
    const Channel<TouchSample>* samples;
  };
  struct Hand {
    std::string name;
    const Channel<HandSample>* samples;
    const SeqSlot<GestureState>* gesture;
  };
  struct Actions {
    std::string source;  // name of a device or a hand, or "panel" for the last entry
    const SeqSlot<ActionState>* slot;
  };

  // Finds the slots of all devices and hands in `table`. `header`: the header of the same segment.
  // Errors: those of SlotTable::channel(), for the first slot that is missing or unsuitable; but a
  // missing `gpio` is no error.
  static Result<DeviceSlots> find(const SlotTable& table, const Header& header);
  // Finds the slots in a segment that this process owns and whose table of fields is filled in.
  // Errors: those of the other find(), and of SlotTable::read().
  static Result<DeviceSlots> find(const DevicesSegment& segment);

  // Each returns the device or hand with this name, or the first one of its kind if `name` is
  // empty; null if there is none.
  const Glove* glove(std::string_view name = {}) const;
  const Tracker* tracker(std::string_view name = {}) const;
  const Ball* ball(std::string_view name = {}) const;
  const Touch* touch(std::string_view name = {}) const;
  const Hand* hand(std::string_view name = {}) const;

  const Header* header = nullptr;
  // Each list is in the order of the table of fields, which is the order of the configuration.
  // `health` contains the devices only; the health of the control panel is the slot "gpio.health".
  std::vector<Health> health;
  std::vector<Glove> gloves;
  std::vector<Tracker> trackers;
  std::vector<Ball> balls;
  std::vector<Touch> touches;
  std::vector<Hand> hands;
  std::vector<Actions> actions;
  const Channel<GpioSample>* gpio = nullptr;  // the control panel; null if not in the table
};

// Returns the name of a device's state: "absent", "opening", "ok" or "failed"; or "stale" if the
// state is ok but was not updated in the last second before `now`.
const char* healthName(const DeviceHealth& health, Timestamp now);

// If a device works for less than this time between two faults with the same reason, messages and
// recordings treat both as one fault.
inline constexpr Duration kBriefly = std::chrono::seconds(5);

}  // namespace merlin::shm
