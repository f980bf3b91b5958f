// Makes a mesh manifold by duplicating vertices.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct SplitReport {
  std::size_t edges = 0;     // edges with more than two triangles, or two in the same direction
  std::size_t vertices = 0;  // vertices with several fans of triangles after these edges are cut
  std::size_t added = 0;     // vertices added, as copies at bit-identical positions
};

// Duplicates vertices until each edge has at most two triangles, which use it in opposite
// directions, and the triangles of each vertex form one fan, open or closed. Triangles keep their
// order and the positions of their corners. The first fan of a vertex keeps its index; the copies
// are appended after all vertices, with the same features.
//
// At an edge with too many triangles, the pairs of triangles that continue each other most smoothly
// stay connected, as far as the result is manifold; all other triangles get a border there.
// coincidentVertices() finds the copies. O(n log n) time, about 50 bytes of temporary memory per
// triangle; the same input gives the same output. Reentrant. REQUIRES: validate(mesh), no triangle
// with a vertex twice, fewer than 2^32 / 3 triangles. Idea: A. Gueziec et al., "Cutting and
// Stitching: Converting Sets of Polygons to Manifold Surfaces", 2001.
SplitReport splitNonManifold(Mesh& mesh);

}  // namespace merlin::render::mesh
