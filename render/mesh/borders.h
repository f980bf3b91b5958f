// Where a surface ends.
#pragma once

#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render {

// For each vertex: whether one of its edges belongs to one triangle only. O(n log n); 24 bytes per
// triangle while it runs.
std::vector<bool> borderVertices(const Mesh& mesh);

}  // namespace merlin::render
