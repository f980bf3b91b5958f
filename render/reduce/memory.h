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

// Peak memory of a reduction in addition to the input mesh, in bytes.
struct ReductionNeed {
  std::size_t whole = 0;  // if the mesh is reduced as a whole
  // if it is reduced in as many blocks as possible; `whole` for a cost that has no blocks
  std::size_t least = 0;
};
ReductionNeed needOf(const mesh::MeshSize& size, const ReduceSettings& settings);

// Memory, in bytes, of a whole job: it reads a mesh file, splits non-manifold edges and vertices,
// reduces the mesh and writes the model. Includes kProgramBytes.
struct JobNeed {
  std::size_t least = 0;    // peak of the job, with the mesh reduced in as many blocks as possible
  std::size_t besides = 0;  // used during the reduction in addition to needOf(): mesh and program
};
// `file_size`: size of the mesh file in bytes; 0 if the mesh is in memory already.
JobNeed needOfJob(const mesh::MeshSize& size, std::size_t file_size,
                  const ReduceSettings& settings);

// Memory that the program takes apart from its data: code, libraries and file buffers [bytes].
inline constexpr std::size_t kProgramBytes = std::size_t{32} << 20;

// Returns the number of blocks in which the mesh must be reduced so that settings.memory suffices;
// 1 means as a whole. Errors: kInvalidArgument if the limit is too low even for the largest number
// of blocks; the message contains the need and the limit.
Result<std::size_t> blocksFor(const mesh::MeshSize& size, const ReduceSettings& settings);

// Returns the share of its triangles (0..1) that each block keeps. `target`: the share of the whole
// mesh's triangles that the caller asked for (0..1).
double shareOfBlocks(double target);

}  // namespace merlin::render::reduce
