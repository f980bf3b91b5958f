// Welds the parts of a mesh where they are one surface: an edge at which one part ends and another
// one begins gets the same two vertices in both. Pure.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct WeldReport {
  std::size_t edges = 0;     // along which two parts were welded
  std::size_t vertices = 0;  // that were removed, since they became one with another
};

// The mesh's feature "label" (1) says which part a vertex belongs to; without it nothing is done.
// Two parts are welded along an edge if
// - it is a border of both, and of no other part, and they run along it in opposite directions;
// - its ends have the same positions, bit by bit (0 is -0), and the same values of all features
//   but "label" and "normal": so never across a seam of a texture or a border of colours;
// - the two triangles at it form an angle of less than 60 degrees, so that a crease stays one.
// A welded vertex gets the lower label. Each triangle keeps a corner with its own part's label: an
// edge for which that cannot be is not welded. So a triangle's part is the highest label of its
// corners. Triangles keep their order and their number. Edges are welded in the order of the
// triangles; the same mesh gives the same result. O(n log n). REQUIRES: validate(mesh).
WeldReport weldParts(Mesh& mesh);

}  // namespace merlin::render::mesh
