// Checks of settings beyond range and type, in particular of values that depend on each other.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. Replaces the settings of the tiles by those of the
// room, if one is given, and completes the devices (config/devices.h).
void checkTogether(LoadedSettings& loaded);

}  // namespace merlin
