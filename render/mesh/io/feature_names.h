// Checks whether a PLY file can hold a feature of a given name.
#pragma once

#include <string>

namespace merlin::render::mesh {

// Returns why a feature cannot have this name, which comes from outside, as the end of a message;
// empty if it can: the name is one word, and no word with another meaning to readers of PLY.
std::string featureNameFault(const std::string& name);

}  // namespace merlin::render::mesh
