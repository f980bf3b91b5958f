// PLY parser, written by hand: it keeps any scalar vertex property, never splits or drops data
// silently, and reports where a file is damaged. README.md says why no library is used. Format: G.
// Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render::mesh::ply {

// `bytes` is a whole file. Faces with more than three corners become triangle fans. The mesh is
// neither validated nor tidied. Errors: kMalformed, kUnsupported, without the file's name.
// pictures  receives the file names in the comments "TextureFile"
Result<LoadedMesh> parse(std::string_view bytes, std::vector<std::string>* pictures = nullptr);

}  // namespace merlin::render::mesh::ply
