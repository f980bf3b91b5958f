// Memory checks of `merlin mesh import`, `info`, `picture` and `reduce`, so that a command stays
// within a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "render/mesh/mesh_size.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// Returns the limit of a command [bytes]: the value of its option --memory, or the free memory if
// that is 0.
std::size_t memoryLimit(std::uint64_t option);

// Returns how many bytes the reduction of a mesh of this size may use in addition to the mesh, so
// that the command stays within `limit` bytes. Checks also that all other steps (reading a file of
// `file_size` bytes, repairs, writing) stay within it. Errors: kInvalidArgument, with the required
// memory and the limit, if even a reduction in blocks does not fit.
Result<std::size_t> roomForReduction(const render::mesh::MeshSize& mesh, std::size_t file_size,
                                     const render::reduce::ReduceSettings& settings,
                                     std::size_t limit);

// Returns how many bytes of the limit of a whole command are left while the mesh and `others` bytes
// of other data are in memory.
std::size_t roomBeside(const render::mesh::Mesh& mesh, std::size_t others, std::size_t limit);

// Returns a number of bytes as a text for a person, "7.5 GiB".
std::string sizeText(std::size_t bytes);

// Checks that the texture file `picture` can be decoded within `limit` bytes while the mesh is in
// memory. Errors: kInvalidArgument. A file that cannot be read is not an error here; the step that
// reads it reports that.
Result<Ok> roomForPicture(const std::string& picture, const render::mesh::MeshSize& mesh,
                          std::size_t limit);

// Checks with meshFileSize(), before the mesh is loaded, that loading it takes at most `limit`
// bytes. `named`: the file that errors name: `path`, or the file from which it was made. Errors:
// kInvalidArgument, with the required memory and the limit. A file that cannot be read or whose
// format states no counts (an ASCII .stl) is not an error here.
Result<Ok> roomToRead(const std::string& path, const std::string& named, std::size_t limit);

// Checks that the edges of `triangles` triangles of the model `path` can be drawn within `limit`
// bytes. Errors: kInvalidArgument, with the required memory and the limit.
Result<Ok> roomForEdges(const std::string& path, std::size_t triangles, std::size_t limit);

// Makes the checks of roomForReduction() and roomForPicture() before the mesh is read, with the
// sizes in the file's header. Errors: kInvalidArgument, with the file's name. A header that cannot
// be read or contains no sizes is not an error here; reading the mesh reports faults.
Result<Ok> checkRoom(const std::string& path, const render::reduce::ReduceSettings& settings,
                     std::size_t limit);

}  // namespace merlin::cli
