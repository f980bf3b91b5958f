// Checks of the settings that all devices of VRPN servers have in common: port and name.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"

namespace merlin::vrpn {

// Adds a fault for a port of the wrong kind, if `driver` is the line's driver. Its JSON pointer is
// "/port".
void checkPort(const LineSettings& line, const char* driver, SettingFaults& faults);

// Adds a fault if no device of a server can have this name. `pointer`: JSON pointer of the name.
void checkName(const std::string& name, const char* pointer, SettingFaults& faults);

}  // namespace merlin::vrpn
