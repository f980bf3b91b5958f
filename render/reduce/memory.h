// Estimates how much memory a reduction will take, before it runs.
//
// The constants come from measurements (quadric/README.md) and are rounded up, because a memory
// limit must be kept. The figures of `./dev bench size` are within 10 % of the estimates.
#pragma once

#include <cstddef>

#include "daemon/base/result.h"
#include "render/mesh/mesh_size.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

// Memory needed in addition to the mesh, in bytes.
struct ReductionNeed {
  std::size_t whole = 0;  // to reduce the mesh as a whole
  std::size_t least = 0;  // in as many blocks as possible; equals `whole` for a cost without blocks
};
ReductionNeed needOf(const mesh::MeshSize& size, const ReduceSettings& settings);

// Returns in how many blocks to reduce the mesh so that settings.memory suffices; 1: as a whole.
// Errors: kInvalidArgument, if the memory does not even suffice for blocks (the message contains
// the need and the limit).
Result<std::size_t> blocksFor(const mesh::MeshSize& size, const ReduceSettings& settings);

// Returns the share (0..1) of its triangles that each block is reduced to if the share `target` of
// the whole mesh's triangles is requested.
double shareOfBlocks(double target);

}  // namespace merlin::render::reduce
