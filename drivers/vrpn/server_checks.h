// What the settings of every device of a VRPN server have in common: its port and its name there.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"

namespace merlin::vrpn {

// Finds a port at which no server can be, if the line has this driver. Pointer: "/port".
void checkPort(const LineSettings& line, const char* driver, SettingFaults& faults);

// Finds a name that no device of a server can have. `pointer`: of the name.
void checkName(const std::string& name, const char* pointer, SettingFaults& faults);

}  // namespace merlin::vrpn
