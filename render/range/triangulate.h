// Triangulates a range image: each pixel in a triangle becomes a vertex, each cell of 2 x 2 pixels
// becomes zero to two triangles.
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
  mesh::Mesh mesh;                        // features: "normal", then the planes in their order
  std::vector<std::uint32_t> pixels;      // by vertex: its pixel, row x width + column
  std::vector<std::uint8_t> on_boundary;  // by vertex: 1 if it is on a border of the surface
  std::size_t returns = 0;                // number of pixels with a return
  std::size_t unused = 0;                 // number of pixels with a return, but in no triangle
  // Number of vertices added where surfaces touch in only one point.
  std::size_t split = 0;
  // Number of plane values that were not finite and became 0.
  std::size_t not_numbers = 0;
};

// Triangulates the image. Each cell is divided by the shorter one of its diagonals that have a
// return at both ends. This diagonal and the cell's sides form up to two triangles; a triangle is
// kept if each of its edges is at most as long as `max_edge` allows at the smaller range of the
// edge's ends ([GOURLEY98] A.6 and [TURK94]). Triangles are counter-clockwise as the scanner sees
// them; their order is that of the cells, row by row.
//
// A pixel whose triangles form several fans becomes one vertex per fan, so that the mesh is
// manifold; validate() and tidy() find nothing to report or remove. Normals: the mean of the unit
// face normals ([GOURLEY98] 4.1), as in mesh::vertexNormals().
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
