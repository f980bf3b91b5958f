// The tables that describe the segments to readers that do not include layout.h: name, type, offset
// and unit of every field. They are stored in the segments and printed by `merlin shm dump`.
#pragma once

#include <string>
#include <vector>

#include "daemon/shm/layout.h"

namespace merlin::shm {

// What the slots of the devices' segment are named after.
struct SlotNames {
  struct Device {
    std::string name;
    SampleKind kind;
  };
  std::vector<Device> devices;  // in the order of DevicesSegment::health
  std::vector<std::string> hands;
};

// The fields of these slots: for each device NAME.health and actions.NAME; for a glove NAME,
// NAME.posture and NAME.posture_state, and for the first glove also posture and posture_state; for
// a tracker NAME1 to NAME4, by station, and NAME for its frames; for a ball, a touch frame or a
// hand NAME; and gpio, gpio.health and actions.panel. REQUIRES: DevicesSegment has room for all of
// them.
std::vector<Field> devicesFields(const SlotNames& names);
std::vector<Field> wallFields();

// The fields of one slot with the name `name` at `offset` in a segment, as in the tables above:
// slotFields() for a SeqSlot<T>, channelFields() for a Channel<T>. T is a type that the devices'
// segment contains.
template <typename T>
std::vector<Field> slotFields(const std::string& name, std::size_t offset);
template <typename T>
std::vector<Field> channelFields(const std::string& name, std::size_t offset);

}  // namespace merlin::shm
