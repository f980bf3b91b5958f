// Where a surface ends.
#pragma once

#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render {

// Of each vertex whether an edge of it is of one triangle only. O(n log n); 24 bytes a triangle
// while it runs.
std::vector<bool> borderVertices(const Mesh& mesh);

}  // namespace merlin::render
