// Finds the border vertices of a mesh.
#pragma once

#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Returns for each vertex whether it lies on a border, i.e. one of its edges belongs to only one
// triangle. O(n log n); needs 24 bytes per triangle while it runs.
std::vector<bool> borderVertices(const Mesh& mesh);

}  // namespace merlin::render::mesh
