// Converts texture coordinates that a file gives to triangle corners to a feature of the vertices.
// Pure.
#pragma once

#include <array>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Sets the feature "texcoord" (2) of the mesh, replacing an existing one. corners: u and v of each
// triangle corner, in the order of mesh.triangles. A vertex whose corners have different
// coordinates is split: corners with the coordinates of its first corner keep the vertex; the
// others get new vertices, which are appended in the order of the corners. O(n log n). REQUIRES:
// validate(mesh), except for "texcoord"; corners.size() equals mesh.triangles.size().
void setCornerCoordinates(Mesh& mesh, const std::vector<std::array<float, 2>>& corners);

}  // namespace merlin::render::mesh
