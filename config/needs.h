// Checks of settings that have no effect without another setting.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding for each setting that has a value other than the default but no effect, because
// the setting that it depends on is not set. REQUIRES: completeDevices() (config/devices.h) was
// called.
void checkNeeds(LoadedSettings& loaded);

}  // namespace merlin
