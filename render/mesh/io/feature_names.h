// Checks whether a PLY file can hold a feature of a given name.
#pragma once

#include <string>

namespace merlin::render::mesh {

// Returns why a feature cannot have this name, as the end of an error message; empty if it can. A
// valid name is one word that has no other meaning to readers of PLY. `name` may come from an
// untrusted source.
std::string featureNameFault(const std::string& name);

}  // namespace merlin::render::mesh
