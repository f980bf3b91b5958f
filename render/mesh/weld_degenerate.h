// Merges coincident vertices that are corners of the same triangle.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// If corners of a triangle have the same position and the same features, merges them into one
// vertex, in all triangles. The triangle then has a vertex twice, and tidy() drops it. (Dropping
// the triangle without merging would open a slit, whose two sides could not be reduced.) Corners
// with different features, such as those at the pole of a textured sphere, are not merged. Returns
// the number of vertices merged into others; they remain in the mesh, unused. O(n). The same input
// gives the same result. REQUIRES: validate(mesh).ok().
std::size_t weldDegenerate(Mesh& mesh);

}  // namespace merlin::render::mesh
