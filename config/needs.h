// Checks of settings that have no effect without another setting.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding for each setting that the configuration sets to a value other than the default,
// without another setting that it needs. REQUIRES: the devices are complete (config/devices.h).
void checkNeeds(LoadedSettings& loaded);

}  // namespace merlin
