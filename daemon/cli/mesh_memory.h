// How much memory `merlin mesh reduce` may take, how much it would, and how much it took.
#pragma once

#include <cstddef>
#include <string>

#include "daemon/base/result.h"
#include "render/mesh/mesh_size.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// What the machine has free, less a sixteenth, or what a limit of this process's address space
// leaves, less an eighth, if that is less; bytes. A very large number where it does not say.
std::size_t freeMemory();

// The most that this process has had in memory so far, bytes; what it maps of files counts.
std::size_t peakMemory();

// What the reduction of a mesh of that size may take beside it, so that the whole command keeps to
// `limit` bytes: reading (of a file of so many bytes), repairs, reduction and writing. Errors:
// kInvalidArgument, with the need and the limit, where not even blocks fit.
Result<std::size_t> roomForReduction(const render::MeshSize& mesh, std::size_t file_size,
                                     const render::ReduceSettings& settings, std::size_t limit);

// Whether a mesh' picture can be looked at beside it. Errors: as above; none where the picture
// cannot be read, since reading it will say that.
Result<Ok> roomForPicture(const std::string& picture, const render::MeshSize& mesh,
                          std::size_t limit);

// The same as roomForReduction() before anything is read, as far as a file says in its header
// (.ply) how much is in it. Errors: with the file's name; none where it cannot be read, since
// reading it will say that.
Result<Ok> checkRoom(const std::string& path, const render::ReduceSettings& settings,
                     std::size_t limit);

}  // namespace merlin::cli
