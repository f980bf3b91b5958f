// Segmentation: clusters the vertices of a mesh in pattern space; each segment is connected on the
// surface. [GOURLEY98] section 6.1; README.md describes the method and the reasons for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render::segment {

struct SegmentSettings {
  std::size_t segments = 8;
  reduce::Weights weights{};  // empty: segmentWeights()
};

struct Segmentation {
  std::vector<std::uint32_t> labels;  // segment of each vertex; 0 is the largest
  std::vector<std::size_t> sizes;     // number of vertices of each segment, in descending order
  double error = 0;  // RMS distance of the pattern vectors from the mean of their segment
};

// Default weights: normal 1, and colour 1 if the mesh has it.
reduce::Weights segmentWeights(const mesh::Mesh& mesh);

// Divides `mesh` into settings.segments segments, or fewer if it has fewer vertices. Coincident
// vertices (coincidentVertices()) count as neighbours. If the mesh has more connected components
// than that, the largest become segments and each of the others joins the one with the nearest
// mean. Errors:
// kInvalidArgument (0 segments; a weight that PatternSpace refuses; a weight of "boundary"). Time:
// O(n log n); memory: 32 bytes per edge, and 8 per vertex and dimension of the pattern. Reentrant;
// the same input gives the same labels. REQUIRES: validate(mesh), at least one vertex, and a
// feature "normal" of dimension 3.
Result<Segmentation> segment(const mesh::Mesh& mesh, const SegmentSettings& settings);

}  // namespace merlin::render::segment
