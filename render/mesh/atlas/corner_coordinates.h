// Gives vertices the texture coordinates that a file has at the corners of its triangles. Pure.
#pragma once

#include <array>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Sets "texcoord" (2). A vertex whose corners have different coordinates is split: its corners with
// the first ones keep it, and further vertices follow all others, in the order of the corners.
// O(n log n). REQUIRES: validate(mesh) but for "texcoord"; an entry for each corner.
void setCornerCoordinates(Mesh& mesh, const std::vector<std::array<float, 2>>& corners);

}  // namespace merlin::render::mesh
