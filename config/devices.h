// Completes the names and speeds of devices that a configuration leaves to the drivers, and finds
// devices.
#pragma once

#include "config/settings.h"

namespace merlin {

// Completes each device that has a known driver: an empty name becomes the name of the device's
// kind ("glove"), and the baud rate 0 becomes the usual rate of the driver. Reentrant.
void completeDevices(std::vector<DeviceSettings>& devices);

// Returns the first device of the kind that has the name `name`, or any name if `name` is empty;
// null if there is none. The pointer is into `devices`.
const DeviceSettings* findDevice(const DevicesSettings& devices, SampleKind kind,
                                 const std::string& name);

}  // namespace merlin
