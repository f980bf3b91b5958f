// Converts colours of facets, which STL, OFF and PLY files may have, to colours of vertices.
#pragma once

#include <span>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Adds the feature "colour" (3): each vertex gets the colour of its triangles. If these have
// several colours, the vertex is duplicated, so that there is one for each colour at the same
// position (coincidentVertices() finds them). Triangles keep their order. Vertices that no triangle
// uses are white. O(n log n).
// colours  triangles x 3, each 0..1
// REQUIRES: validate(mesh), and the mesh has no feature "colour".
void colourByFacets(std::span<const float> colours, Mesh& mesh);

}  // namespace merlin::render::mesh
