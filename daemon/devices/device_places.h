// Determines which slots in shared memory belong to the configured devices and hands.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"
#include "daemon/shm/fields.h"

namespace merlin::devices {

// Place of a device's samples in shared memory. Its health and its actions have the index that the
// device has in the list of devices.
struct DevicePlace {
  SampleKind kind;
  std::size_t of_kind;  // index of its samples: the number of earlier devices of its kind
};

// Returns the places of all devices, in the order of settings.list. REQUIRES: the driver of every
// device exists.
std::vector<DevicePlace> devicePlaces(const DevicesSettings& settings);

// Returns the names of devices and hands, from which the names of the slots are formed. REQUIRES:
// the driver of every device exists.
shm::SlotNames slotNames(const DevicesSettings& settings);

// Returns DevicePlace::of_kind of the device of this kind with this name, or 0, the first one of
// this kind, if `name` is empty; nothing if there is no such device. REQUIRES: the driver of every
// device exists.
std::optional<std::size_t> placeOf(const DevicesSettings& settings, SampleKind kind,
                                   std::string_view name);

}  // namespace merlin::devices
