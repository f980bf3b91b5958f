// OBJ through OpenMesh's reader, into our flat arrays.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render {

// The mesh is neither validated nor tidied. Errors: kMalformed, kIo, without the file's name.
Result<LoadedMesh> readWithOpenMesh(const std::string& path, std::string_view content);

}  // namespace merlin::render
