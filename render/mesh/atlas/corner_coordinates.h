// Converts a file's texture coordinates at triangle corners to a feature of the vertices. Pure.
#pragma once

#include <array>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Sets "texcoord" (2). A vertex whose corners have different coordinates is split: corners with the
// coordinates of its first corner keep the vertex; the others get new vertices, which are appended
// in the order of the corners. O(n log n). REQUIRES: validate(mesh) but for "texcoord"; an entry
// for each corner.
void setCornerCoordinates(Mesh& mesh, const std::vector<std::array<float, 2>>& corners);

}  // namespace merlin::render::mesh
