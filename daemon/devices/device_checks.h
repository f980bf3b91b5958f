// What the configuration says of devices, held against the files that it names: the loader reads no
// other file.
#pragma once

#include "config/loader.h"

namespace merlin::devices {

// Adds findings: a network that cannot be read, bindings to postures that it does not know.
// Bindings that stand in the file alone: a network without a posture that is bound by default is
// no mistake of anybody's.
void checkPostures(LoadedSettings& loaded);

// Adds findings: a port that cannot be read, a transcript ("replay:FILE") that cannot be played.
// A device that is not there is none: it may come.
void checkPorts(LoadedSettings& loaded);

}  // namespace merlin::devices
