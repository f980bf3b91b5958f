// Makes one vertex of those that lie in one place and are joined by a triangle.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Corners of a triangle that lie in the same place and have the same features become one vertex, in
// all triangles, so that the triangle has a vertex twice and tidy() drops it. To drop it alone
// would open a slit, and with it the two sides of the slit cannot be reduced. Corners with other
// features, such as the pole of a textured sphere, stay apart. Returns how many vertices were
// merged into others; they stay, unused. O(n). Same input, same result. REQUIRES:
// validate(mesh).ok().
std::size_t weldDegenerate(Mesh& mesh);

}  // namespace merlin::render::mesh
