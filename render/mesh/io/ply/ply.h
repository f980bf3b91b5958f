// PLY, read by hand: the one reader that keeps any vertex property, does not split or
// drop anything silently, and says where a file is broken. See README.md for why not a library.
// Format: G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render::ply {

// `bytes` is a whole file. Faces of more than three corners become fans. The mesh is neither
// validated nor tidied. Errors: kMalformed, kUnsupported, without the file's name.
// pictures  gets the names of files that its comments "TextureFile" have
Result<LoadedMesh> parse(std::string_view bytes, std::vector<std::string>* pictures = nullptr);

}  // namespace merlin::render::ply
