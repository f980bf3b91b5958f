// Memory of `merlin mesh reduce`: what is available, what it needs, and what it used.
#pragma once

#include <cstddef>
#include <string>

#include "daemon/base/result.h"
#include "render/mesh/mesh_size.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// Available memory in bytes: the machine's free memory less a sixteenth, or what the limit of this
// process' address space leaves less an eighth, whichever is smaller. A very large number if
// neither is known.
std::size_t freeMemory();

// Peak resident memory of this process so far in bytes, mapped files included.
std::size_t peakMemory();

// Bytes that the reduction of a mesh of that size may use beside the mesh, so that all steps of the
// command (reading a file of `file_size` bytes, repairs, reduction, writing) stay within `limit`
// bytes. Errors: kInvalidArgument, with need and limit, if not even a reduction in blocks fits.
Result<std::size_t> roomForReduction(const render::MeshSize& mesh, std::size_t file_size,
                                     const render::ReduceSettings& settings, std::size_t limit);

// Checks that the texture's picture can be decoded while the mesh is in memory. Errors:
// kInvalidArgument; none if the picture cannot be read, because reading it will report that.
Result<Ok> roomForPicture(const std::string& picture, const render::MeshSize& mesh,
                          std::size_t limit);

// The check of roomForReduction() before the mesh is read, from the sizes in the file's header.
// Errors: kInvalidArgument, with the file's name; none if the header does not say them or
// cannot be read; reading the mesh will report that.
Result<Ok> checkRoom(const std::string& path, const render::ReduceSettings& settings,
                     std::size_t limit);

}  // namespace merlin::cli
