// Values of features that are not numbers, as programs mark what they have not measured.
#pragma once

#include <string>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Puts 0 where a value of a feature is not a finite number, and returns a note for the user, empty
// if there was none. O(values).
std::string replaceNonNumbers(std::vector<Feature>& features);

}  // namespace merlin::render::mesh
