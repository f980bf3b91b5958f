// Estimates of the memory that a reduction takes, before it runs.
//
// Estimates from measurements (README.md), a little above them, since a limit is a promise: those
// of `./dev bench size` are within a tenth.
#pragma once

#include <cstddef>

#include "daemon/base/result.h"
#include "render/mesh/mesh_size.h"
#include "render/reduce/reduce.h"

namespace merlin::render {

// Bytes beside the mesh.
struct ReductionNeed {
  std::size_t whole = 0;  // all at once
  std::size_t least = 0;  // in as many blocks as help; the same where the cost has no blocks
};
ReductionNeed needOf(const MeshSize& size, const ReduceSettings& settings);

// How many blocks settings.memory asks for; 1 for the mesh as a whole. Errors: kInvalidArgument,
// where not even blocks fit, with the need and the limit.
Result<std::size_t> blocksFor(const MeshSize& size, const ReduceSettings& settings);

// Share of its triangles that a block keeps if `target` of all are asked for.
double shareOfBlocks(double target);

}  // namespace merlin::render
