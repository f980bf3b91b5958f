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

// Memory of a whole job, which reads a mesh file, splits its non-manifold edges and vertices,
// reduces the mesh and writes the model; in bytes, with the program itself.
struct JobNeed {
  std::size_t least = 0;    // peak of the job if the mesh is reduced in as many blocks as possible
  std::size_t besides = 0;  // during the reduction, apart from what needOf() counts
};
// `file_size`: of the file that is read, in bytes; 0 if the mesh is in memory already.
JobNeed needOfJob(const mesh::MeshSize& size, std::size_t file_size,
                  const ReduceSettings& settings);

// Memory of a program and of its file buffers, in addition to its data [bytes].
inline constexpr std::size_t kProgramBytes = std::size_t{32} << 20;

// Returns in how many blocks to reduce the mesh so that settings.memory suffices; 1: as a whole.
// Errors: kInvalidArgument, if the memory does not even suffice for blocks (the message contains
// the need and the limit).
Result<std::size_t> blocksFor(const mesh::MeshSize& size, const ReduceSettings& settings);

// Returns the share (0..1) of its triangles that each block is reduced to if the share `target` of
// the whole mesh's triangles is requested.
double shareOfBlocks(double target);

}  // namespace merlin::render::reduce
