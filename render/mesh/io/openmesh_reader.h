// OBJ through OpenMesh's reader, into our flat arrays.
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render {

// `content` is a whole file. The mesh is neither validated nor tidied. Errors: kMalformed, without
// the file's name.
Result<LoadedMesh> readWithOpenMesh(std::string_view content);

}  // namespace merlin::render
