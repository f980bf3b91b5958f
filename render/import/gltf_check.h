// What of a glTF file assimp would read wrongly, found in its JSON before assimp reads it.
#pragma once

#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::import {

// `file`: a whole .gltf or .glb of glTF 2; any other version is left to assimp. May throw
// std::bad_alloc. Errors, without the file's name: kMalformed (no JSON, or of another form),
// kUnsupported (a required extension that is not read; coordinates or weights that are no floats,
// whose bytes assimp 5.2 copies as if they were).
Result<Ok> checkGltf(std::string_view file);

}  // namespace merlin::render::import
