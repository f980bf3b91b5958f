// Checks of the settings that all devices of VRPN servers have in common: port and name.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"

namespace merlin::vrpn {

// Finds a port of the wrong kind, if `driver` is the line's driver. Pointer: "/port".
void checkPort(const LineSettings& line, const char* driver, SettingFaults& faults);

// Finds a name that no device of a server can have. `pointer`: JSON pointer of the name.
void checkName(const std::string& name, const char* pointer, SettingFaults& faults);

}  // namespace merlin::vrpn
