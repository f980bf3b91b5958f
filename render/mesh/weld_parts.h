// Welds the parts of a mesh where they form one surface: if one part ends at an edge and another
// begins there, both parts get the same two vertices. Pure.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct WeldReport {
  std::size_t edges = 0;     // edges along which two parts were welded
  std::size_t vertices = 0;  // vertices that were removed because they were merged into others
};

// Welds the parts of a mesh. The mesh's feature "label" (1) gives the part of each vertex; without
// this feature nothing is done.
// Two parts are welded along an edge if
// - it is a border of both and of no other part, and their triangles use it in opposite directions;
// - its ends have bit-identical positions (but 0 equals -0) in both parts, and the same values of
//   all features but "label" and "normal"; so seams of textures and colours are not welded;
// - the normals of its two triangles form an angle of less than 60 degrees; so creases stay.
// A welded vertex gets the lower label. An edge is not welded if a triangle would then have no
// corner left with its own part's label. So a triangle's part is the highest label of its corners.
// Triangles keep their order and their number. Edges are welded in the order of the triangles; the
// same mesh gives the same result. O(n log n). REQUIRES: validate(mesh).
WeldReport weldParts(Mesh& mesh);

}  // namespace merlin::render::mesh
