// Replaces feature values that are not numbers, which some programs use to mark missing
// measurements.
#pragma once

#include <string>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Sets each feature value that is not a finite number to 0. Returns a note for the user, empty if
// there was no such value. O(values).
std::string replaceNonNumbers(std::vector<Feature>& features);

}  // namespace merlin::render::mesh
