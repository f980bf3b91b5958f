// Colours of facets, as STL, OFF and PLY files may have them, as colours of vertices.
#pragma once

#include <span>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Adds "colour" (3): that of the triangles at a vertex. A vertex at which triangles of several
// colours meet becomes one for each colour, at the same place (coincidentVertices() finds them);
// triangles keep their order. Vertices of no triangle are white. O(n log n).
// colours  triangles x 3, each 0..1
// REQUIRES: validate(mesh), and that it has no feature "colour".
void colourByFacets(std::span<const float> colours, Mesh& mesh);

}  // namespace merlin::render::mesh
