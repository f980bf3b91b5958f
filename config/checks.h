// Checks of settings beyond range and type, above all of values that must fit one another.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds a finding to `loaded` for each fault.
void checkTogether(LoadedSettings& loaded);

}  // namespace merlin
