// Builds the tables that describe the segments to readers that do not include layout.h: name, type,
// offset and unit of every field. The tables are stored in the segments; `merlin shm dump` prints
// them.
#pragma once

#include <string>
#include <vector>

#include "daemon/shm/layout.h"

namespace merlin::shm {

// Names of the configured devices and hands, from which the names of the slots in the devices'
// segment are formed.
struct SlotNames {
  struct Device {
    std::string name;
    SampleKind kind;
  };
  std::vector<Device> devices;  // in the order of DevicesSegment::health
  std::vector<std::string> hands;
};

// Returns the table of the devices' segment. Its slots are: for each device NAME.health and
// actions.NAME; for a glove also NAME, NAME.posture and NAME.posture_state, and for the first glove
// also posture and posture_state; for a tracker NAME1 to NAME4, by station, and NAME for the frames
// of its stations; for a ball or a touch surface NAME; for a hand NAME, NAME.gesture and
// actions.NAME; and gpio, gpio.health and actions.panel. REQUIRES: DevicesSegment has room for all
// of them.
std::vector<Field> devicesFields(const SlotNames& names);
std::vector<Field> wallFields();

// Return the fields of one slot with the name `name` at `offset` [bytes] in a segment, as
// devicesFields() lists them: slotFields() for a SeqSlot<T>, channelFields() for a Channel<T>. T is
// the type of a slot of the devices' segment.
template <typename T>
std::vector<Field> slotFields(const std::string& name, std::size_t offset);
template <typename T>
std::vector<Field> channelFields(const std::string& name, std::size_t offset);

}  // namespace merlin::shm
