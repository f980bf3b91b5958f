// Lengths of a mesh's edges in pattern space, by which the cost `pattern` orders its collapses.
#pragma once

#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::render::reduce {

// Returns for each corner of each triangle, in the order of mesh.triangles, the length of the edge
// from this corner to the triangle's next one: the distance of the weighted pattern vectors of its
// ends before the first collapse, [GOURLEY98] equation 4.3 and section 5.1. O(triangles).
// Reentrant. Errors: those of PatternSpace::make(). REQUIRES: as reduce().
Result<std::vector<float>> edgeLengths(const mesh::Mesh& mesh, const Weights& weights);

}  // namespace merlin::render::reduce
