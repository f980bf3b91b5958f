// Checks of /devices and /hands, and of other settings that name a device: bindings, the viewer's
// head.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. REQUIRES: completeDevices().
void checkDevices(LoadedSettings& loaded);

// Whether the port is merlind's own VRPN server (/serve/vrpn_port), so that a device that is read
// there would feed itself. Compares the address as it is written; host names are not resolved.
bool isOwnVrpnServer(const PortAddress& port, const ServeSettings& serve);

// Adds the faults as findings. `group`: JSON pointer to which the faults' pointers are relative.
// `prefix`: precedes texts of faults that are not predicates, "cannot be used: ".
void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix = {});

}  // namespace merlin
