// Finds what assimp would read wrongly in a glTF file, by checking its JSON before assimp reads it.
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

// What the file's JSON declares about a primitive.
struct GltfPrimitive {
  std::size_t mesh = 0, number = 0;  // each from 0
  std::uint64_t triangles = 0;       // 0 for lines and points
};

struct GltfPromise {
  std::vector<GltfPrimitive> primitives;  // in the file's order
  // Names of application-specific attributes, such as _CONFIDENCE, which assimp does not read;
  // without control characters, and truncated.
  std::set<std::string> own_attributes;
  std::vector<GltfValues> own;  // what was found of them, in the buffers
};

// `file`: a whole .gltf or .glb file; `buffers`: its buffers, which are needed as long as `own` of
// the result. Returns what it declares; an empty GltfPromise for any
// version but glTF 2, which is left to assimp. assimp 5.2 drops triangles whose indices are out of
// range, so it may deliver fewer than declared. May throw std::bad_alloc. Errors, without the
// file's name: kMalformed (no JSON, or of another form), kUnsupported (a required extension that is
// not supported; coordinates or weights that are not floats, whose bytes assimp 5.2 copies as if
// they were).
Result<GltfPromise> checkGltf(std::string_view file, GltfBuffers& buffers);

}  // namespace merlin::render::import
