// Names of features that a PLY file can hold.
#pragma once

#include <string>

namespace merlin::render::mesh {

// Why a feature of a name from outside cannot have it, as the end of a message; empty if it can: it
// is one word, and none that means something else to readers of PLY.
std::string featureNameFault(const std::string& name);

}  // namespace merlin::render::mesh
