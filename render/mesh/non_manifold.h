// Splits a mesh that is not manifold until it is.
#pragma once

#include <cstddef>

#include "render/mesh/mesh.h"

namespace merlin::render {

struct SplitReport {
  std::size_t edges = 0;     // of more than two triangles, or of two that run the same way
  std::size_t vertices = 0;  // that had more than one fan of triangles once those were cut
  std::size_t added = 0;     // vertices made; they lie where those did, bit by bit
};

// Gives vertices twins until each edge has at most two triangles, which run opposite ways, and the
// triangles of each vertex are one fan, open or closed. Triangles stay as they are and in order; a
// vertex' first fan keeps its number, twins stand behind all others with the same features.
//
// At an edge of too many triangles those that continue one another most smoothly stay together, as
// far as that gives a manifold; the others are borders from then on. samePlace() finds the twins.
// O(n log n) time, 28 bytes a triangle besides; same input, same output. Reentrant.
// REQUIRES: validate(mesh), no triangle with a vertex twice, fewer than 2^32 / 3 triangles.
// Idea: A. Gueziec et al., "Cutting and Stitching: Converting Sets of Polygons to Manifold
// Surfaces", 2001.
SplitReport splitNonManifold(Mesh& mesh);

}  // namespace merlin::render
