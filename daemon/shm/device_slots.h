// DeviceSlots: what a reader uses of the devices' segment. Each slot is found by its name in the
// segment's table of fields, once, when the segment is opened.
#pragma once

#include <array>
#include <span>
#include <string>
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

  // Finds all members. Errors: those of SlotTable::channel().
  static Result<DeviceSlots> find(const SlotTable& table, const Header& header);
  // The same for a segment of this process, whose table is filled in.
  static Result<DeviceSlots> find(const DevicesSegment& segment);

  const Header* header = nullptr;
  // Of each device that the table names "NAME.health", in its order; without the control panel,
  // which is "gpio".
  std::vector<Health> health;
  const SeqSlot<DeviceHealth>* glove_health = nullptr;
  const SeqSlot<DeviceHealth>* tracker_health = nullptr;
  const SeqSlot<DeviceHealth>* ball_health = nullptr;
  const Channel<GloveSample>* glove = nullptr;
  const Channel<PostureSample>* posture = nullptr;
  const SeqSlot<PostureState>* posture_state = nullptr;
  std::array<const Channel<TrackerSample>*, kStations> tracker{};  // index: station - 1
  const SeqSlot<TrackerFrames>* tracker_frames = nullptr;
  const Channel<BallSample>* ball = nullptr;
  const Channel<HandSample>* hand = nullptr;
  const Channel<GpioSample>* gpio = nullptr;  // null if the segment lacks it
  std::array<const SeqSlot<ActionState>*, kActionSources> actions{};
};

// State of a device for people and programs: "absent", "opening", "ok", "failed"; "stale" if an ok
// health was not updated for a second.
const char* healthName(const DeviceHealth& health, Timestamp now);

}  // namespace merlin::shm
