// Checks of /devices, /hands, and of what names a device elsewhere: bindings, the viewer's head.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. REQUIRES: completeDevices().
void checkDevices(LoadedSettings& loaded);

// Whether the port is that at which merlind itself serves by /serve/vrpn_port: a device that is
// read there would feed itself. By the address as it is written: names are not looked up.
bool isOwnVrpnServer(const PortAddress& port, const ServeSettings& serve);

// Adds the faults as findings. `group`: JSON pointer to which the faults' pointers are relative.
// `prefix`: precedes texts of faults that are not predicates, "cannot be used: ".
void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix = {});

}  // namespace merlin
