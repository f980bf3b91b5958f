// What no single setting can be wrong about: values that must fit one another.
#pragma once

#include "config/loader.h"

namespace merlin {

// Adds findings.
void checkTogether(LoadedSettings& loaded);

}  // namespace merlin
