// Checks of /devices, /hands, and of what names a device elsewhere: bindings, the viewer's head.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. REQUIRES: completeDevices().
void checkDevices(LoadedSettings& loaded);

// Adds the faults as findings. `group`: JSON pointer to which the faults' pointers are relative.
// `prefix`: precedes texts of faults that are not predicates, "cannot be used: ".
void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix = {});

}  // namespace merlin
