// What of a glTF file assimp would read wrongly, found in its JSON before assimp reads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/import/gltf_values.h"

namespace merlin::render::import {

// What the file promises of a primitive.
struct GltfPrimitive {
  std::size_t mesh = 0, number = 0;  // each from 0
  std::uint64_t triangles = 0;       // 0 of lines and points
};

struct GltfPromise {
  std::vector<GltfPrimitive> primitives;  // in the file's order
  // Attributes of the program that wrote it, such as _CONFIDENCE, without control characters and
  // cut: assimp reads none.
  std::set<std::string> own_attributes;
  GltfValues own;  // of these, what was read; NaN is left in it
};

// `file`: a whole .gltf or .glb of glTF 2; any other version is left to assimp.
// Returns what it promises; nothing for another version. assimp 5.2 leaves out
// triangles whose indices are out of range, so that fewer come. May throw std::bad_alloc. Errors,
// without the file's name: kMalformed (no JSON, or of another form), kUnsupported (a required
// extension that is not read; coordinates or weights that are no floats, whose bytes assimp 5.2
// copies as if they were).
Result<GltfPromise> checkGltf(std::string_view file);

}  // namespace merlin::render::import
