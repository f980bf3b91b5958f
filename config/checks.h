// Checks of settings beyond their type and range, in particular of settings that depend on each
// other.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault. Also completes the devices (config/devices.h),
// replaces the tile settings by those computed from the room if a room is given, and computes
// automatic blend ramps.
void checkTogether(LoadedSettings& loaded);

}  // namespace merlin
