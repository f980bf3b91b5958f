// Completes what a configuration leaves to the drivers, names and speeds of devices, and finds
// devices.
#pragma once

#include "config/settings.h"

namespace merlin {

// Gives each device whose driver is known a name (that of its kind), if it has none, and the
// driver's usual speed, if its own is 0. Reentrant.
void completeDevices(std::vector<DeviceSettings>& devices);

// The first device of the kind; null if there is none. `name`: only the one with this name; empty:
// any.
const DeviceSettings* findDevice(const DevicesSettings& devices, SampleKind kind,
                                 const std::string& name);

}  // namespace merlin
