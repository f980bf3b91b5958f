// What the configuration says of postures, held against the network that it names: the loader reads
// no other file.
#pragma once

#include "config/loader.h"

namespace merlin::devices {

// Adds findings: a network that cannot be read, bindings to postures that it does not know.
void checkPostures(LoadedSettings& loaded);

}  // namespace merlin::devices
