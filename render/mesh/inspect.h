// What a mesh is like, counted: its parts, its holes, and what is odd about it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// The values of a feature, over all its dimensions.
struct ValueRange {
  float low = 0, high = 0;      // of the numbers; both 0 if there are none
  std::size_t not_numbers = 0;  // infinite values included
};

// A hole: a connected piece of the border. An open surface has at least one, its outline.
struct Hole {
  double length = 0;  // [model units]
  std::size_t edges = 0;
};

struct Inspection {
  Box box;                                // of the vertices that have finite coordinates
  std::size_t components = 0;             // sets of triangles that are connected by vertices
  std::size_t closed = 0;                 // of them, without border, and with two sides everywhere
  std::size_t inside_out = 0;             // of those, with a negative volume
  double volume = 0;                      // of all closed components [model units^3]
  std::vector<Hole> holes;                // the longest first
  std::size_t degenerate = 0;             // triangles with the same place at two corners
  std::size_t no_area = 0;                // other triangles whose corners are on one line
  std::size_t duplicate = 0;              // triangles with the corners of an earlier one
  std::size_t non_manifold_edges = 0;     // with more than two triangles
  std::size_t turned_edges = 0;           // whose two triangles face different ways
  std::size_t non_manifold_vertices = 0;  // whose triangles are not connected by edges there
  std::size_t isolated = 0;               // vertices that no triangle uses
  std::size_t not_finite = 0;             // vertices with a coordinate that is not a finite number
  std::size_t not_unit = 0;               // vertices whose normal is not of length one
};

// Counts all of it. Vertices at the same place are one vertex, so that a texture's seam is no
// border, nor are the copies that splitNonManifold() makes; but if a coordinate is not finite, each
// vertex is its own. Degenerate and duplicate triangles are counted and then left out. Expected
// O(n), apart from the sorting of the triangles at each vertex; about 100 bytes per triangle. Same
// input, same result. Reentrant. REQUIRES: every index is in range, every feature of its size.
Inspection inspect(const Mesh& mesh);

ValueRange rangeOf(const Feature& feature);

}  // namespace merlin::render::mesh
