// Triangulates a range image: its pixels become vertices, its 2 x 2 cells zero to two triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/mesh/mesh.h"
#include "render/range/range_image.h"
#include "render/range/threshold.h"
#include "render/range/work.h"

namespace merlin::render::range {

struct RangeMesh {
  mesh::Mesh mesh;                    // with "normal" and the planes as features, in their order
  std::vector<std::uint32_t> pixels;  // of each vertex: row x width + column
  std::vector<std::uint8_t> on_boundary;  // of each vertex: 1 if it is on a border of the surface
  std::size_t returns = 0;                // pixels with a return
  std::size_t unused = 0;                 // of these, in no triangle
  std::size_t split = 0;                  // vertices added where surfaces touch in one point only
  std::size_t not_numbers = 0;            // values of planes that were not finite; 0 stands there
};

// In each cell the shorter diagonal with two returns is taken; it and the sides form triangles of
// which every edge is at most as long as `max_edge` allows at the smaller range of its ends
// ([GOURLEY98] A.6 and [TURK94]). Triangles are counter-clockwise as the scanner sees them; their
// order is that of the cells, row by row.
//
// A pixel whose triangles form several fans becomes a vertex for each, so the mesh is what
// splitNonManifold() would leave; validate() and tidy() find nothing in it. Normals: the mean of
// the unit face normals ([GOURLEY98] 4.1), as mesh::vertexNormals() has them.
//
// points  pointsOf(image)
// cost    O(pixels), about 100 bytes a pixel with the mesh
// order   the same input gives the same mesh, whatever the number of threads
// REQUIRES: faultOf(image) is empty. Reentrant.
RangeMesh triangulate(const RangeImage& image, const std::vector<float>& points,
                      const Threshold& max_edge, const Work& work);

// Adds texture coordinates (u, v), v upwards, for a picture that covers the image from edge to
// edge.
void addTexcoords(RangeMesh& mesh, const RangeImage& image);

}  // namespace merlin::render::range
