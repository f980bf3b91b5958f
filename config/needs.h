// Settings that have no effect alone.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding for each setting that the configuration sets, to another value than the default,
// without another one that it needs. REQUIRES: the devices are complete (config/devices.h).
void checkNeeds(LoadedSettings& loaded);

}  // namespace merlin
