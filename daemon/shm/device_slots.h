// DeviceSlots: what a reader uses of the devices' segment. Each slot is found by its name in the
// segment's table of fields, once, when the segment is opened.
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

// Pointers into a segment, which must outlive them. Reentrant.
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
    std::string source;  // name of a device or a hand; of the last one "panel"
    const SeqSlot<ActionState>* slot;
  };

  // Finds all members. Errors: those of SlotTable::channel().
  static Result<DeviceSlots> find(const SlotTable& table, const Header& header);
  // The same for a segment of this process, whose table is filled in.
  static Result<DeviceSlots> find(const DevicesSegment& segment);

  // The device with this name, or the first of its kind if `name` is empty; null if there is none.
  const Glove* glove(std::string_view name = {}) const;
  const Tracker* tracker(std::string_view name = {}) const;
  const Ball* ball(std::string_view name = {}) const;
  const Touch* touch(std::string_view name = {}) const;
  const Hand* hand(std::string_view name = {}) const;

  const Header* header = nullptr;
  // Each list is in the table's order, which is that of the configuration. `health` has the devices
  // only; the control panel's health is "gpio.health".
  std::vector<Health> health;
  std::vector<Glove> gloves;
  std::vector<Tracker> trackers;
  std::vector<Ball> balls;
  std::vector<Touch> touches;
  std::vector<Hand> hands;
  std::vector<Actions> actions;
  const Channel<GpioSample>* gpio = nullptr;  // null if the segment lacks it
};

// State of a device for people and programs: "absent", "opening", "ok", "failed"; "stale" if an ok
// health was not updated for a second.
const char* healthName(const DeviceHealth& health, Timestamp now);

// If a device works for less than this between two equal faults, messages and recordings treat them
// as one fault.
inline constexpr Duration kBriefly = std::chrono::seconds(5);

}  // namespace merlin::shm
