// Computes the lengths of a mesh's edges in pattern space; the cost `pattern` orders its collapses
// by these lengths.
#pragma once

#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render::reduce {

// Returns the length of each triangle's three edges in pattern space: entry 3 t + k is the edge
// from corner k of triangle t to its next corner. The length is the distance between the weighted
// pattern vectors of the edge's ends before the first collapse, [GOURLEY98] equation 4.3 and
// section 5.1. O(triangles). Reentrant. Errors: those of PatternSpace::make(). REQUIRES: as
// reduce().
Result<std::vector<float>> edgeLengths(const mesh::Mesh& mesh, const Weights& weights);

}  // namespace merlin::render::reduce
