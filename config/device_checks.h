// Checks of /devices and /hands, and of other settings that name a device (the bindings and the
// tracker of the viewer's head).
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. REQUIRES: completeDevices().
void checkDevices(LoadedSettings& loaded);

// Returns whether the port is merlind's own VRPN server (/serve/vrpn_port); merlind would then read
// its own output as input. Compares the address as it is written; host names are not resolved.
bool isOwnVrpnServer(const PortAddress& port, const ServeSettings& serve);

// Adds each fault to `loaded` as a finding. `group`: JSON pointer to which the faults' pointers are
// relative. `prefix`: put before the text of each fault, such as "cannot be used: ".
void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix = {});

}  // namespace merlin
