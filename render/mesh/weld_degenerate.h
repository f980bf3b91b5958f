// Merges coincident vertices that are corners of the same triangle.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Merges corners of a triangle that have the same position and the same features into one vertex,
// in all triangles; the triangle then has a vertex twice and tidy() drops it. Dropping the triangle
// without merging would open a slit, whose two sides could not be reduced. Corners with different
// features, such as those at the pole of a textured sphere, are not merged. Returns how many
// vertices were merged into others; they remain in the mesh, unused. O(n). Same input, same result.
// REQUIRES: validate(mesh).ok().
std::size_t weldDegenerate(Mesh& mesh);

}  // namespace merlin::render::mesh
