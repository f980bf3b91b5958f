// Segmentation: the vertices of a mesh clustered in pattern space, connected over the surface.
// [GOURLEY98] section 6.1; how, and why so: README.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render {

struct SegmentSettings {
  std::size_t segments = 8;
  Weights weights{};  // empty: segmentWeights()
};

struct Segmentation {
  std::vector<std::uint32_t> labels;  // of each vertex: 0 is the largest segment
  std::vector<std::size_t> sizes;     // vertices of each segment, falling
  double error = 0;  // RMS distance of the pattern vectors from the mean of their segment
};

// Normals 1, and colours 1 where the mesh has them.
Weights segmentWeights(const Mesh& mesh);

// Segments of `mesh`: as many as asked for, fewer where it has fewer vertices. Vertices in one
// place (samePlace()) are neighbours. Where the mesh has more components than segments are asked
// for, the largest stay, and each other one joins that whose mean is nearest. Errors:
// kInvalidArgument: no segments; a weight that PatternSpace refuses, or of "boundary". O(n log n)
// time, 32 bytes an edge and 8 a pattern's dimension and vertex besides. Reentrant; same input,
// same labels. REQUIRES: validate(mesh), a vertex or more, and a feature "normal" of dimension 3.
Result<Segmentation> segment(const Mesh& mesh, const SegmentSettings& settings);

}  // namespace merlin::render
