// Where the configured devices and hands have their slots in shared memory.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"
#include "daemon/shm/fields.h"

namespace merlin::devices {

// A device's place: its index in the list of devices is that of its health and its actions.
struct DevicePlace {
  SampleKind kind;
  std::size_t of_kind;  // how many devices of its kind are before it: the index of its samples
};

// The places of all devices, in the order of the list. REQUIRES: every driver exists.
std::vector<DevicePlace> devicePlaces(const DevicesSettings& settings);

// The names from which the slots' names are formed. REQUIRES: as above.
shm::SlotNames slotNames(const DevicesSettings& settings);

// How many devices of this kind are before the one named `name`, or 0 for the first one if `name`
// is empty; nothing if there is none. REQUIRES: as above.
std::optional<std::size_t> placeOf(const DevicesSettings& settings, SampleKind kind,
                                   std::string_view name);

}  // namespace merlin::devices
