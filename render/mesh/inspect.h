// Inspects a mesh: counts its parts, its holes and its defects.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Range of a feature's values, over all of its dimensions and vertices.
struct ValueRange {
  float low = 0, high = 0;      // range of the finite values; both 0 if there are none
  std::size_t not_numbers = 0;  // count of NaNs and infinite values
};

// A hole is a connected piece of the border. An open surface has at least one hole, which is its
// outline.
struct Hole {
  double length = 0;  // [model units]
  std::size_t edges = 0;
};

struct Inspection {
  Box box;                                // bounding box of the vertices with finite coordinates
  std::size_t components = 0;             // connected parts, as in render/mesh/parts.h
  std::size_t closed = 0;                 // number of closed parts
  std::size_t inside_out = 0;             // closed parts that face inwards
  double volume = 0;                      // signed sum over all closed parts [model units^3]
  std::vector<Hole> holes;                // longest first
  std::size_t degenerate = 0;             // triangles with two corners at the same position
  std::size_t no_area = 0;                // other triangles whose corners are on one line
  std::size_t duplicate = 0;              // triangles with the same corners as an earlier one
  std::size_t non_manifold_edges = 0;     // edges with more than two triangles
  std::size_t turned_edges = 0;           // edges whose two triangles face opposite sides
  std::size_t non_manifold_vertices = 0;  // vertices with more than one fan of triangles
  std::size_t isolated = 0;               // vertices that no triangle uses
  std::size_t not_finite = 0;             // vertices with a coordinate that is not a finite number
  std::size_t not_unit = 0;               // vertices whose normal is not of length one
};

// Inspects the mesh and fills in all fields of Inspection. Coincident vertices count as one vertex,
// for parts only where a surface ends (parts.h), so that neither the seams of a texture nor the
// copies that splitNonManifold() makes count as borders; but if any coordinate of the mesh is not
// finite, no vertices are joined. Degenerate and duplicate triangles are counted and then ignored,
// with two exceptions in parts and volume: a surface that exists twice counts twice, and a closed
// part of which only some triangles exist twice is not closed. Expected O(n), apart from sorting
// the triangles of each vertex; about 100 bytes per triangle, 250 if triangles share no vertices.
// The same input gives the same result. Reentrant. REQUIRES: every index is in range, every feature
// has the right size.
Inspection inspect(const Mesh& mesh);

ValueRange rangeOf(const Feature& feature);

}  // namespace merlin::render::mesh
