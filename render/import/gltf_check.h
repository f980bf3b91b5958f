// Checks the JSON of a glTF file before assimp reads the file, to find contents that assimp would
// read wrongly.
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

// The properties of a primitive that the file's JSON declares.
struct GltfPrimitive {
  std::size_t mesh = 0, number = 0;  // indices of the mesh and of the primitive in it, from 0
  std::uint64_t triangles = 0;       // number of triangles; 0 for lines and points
};

struct GltfPromise {
  std::vector<GltfPrimitive> primitives;  // in the file's order
  // Names of application-specific attributes, such as _CONFIDENCE, which assimp does not read;
  // without control characters, and truncated.
  std::set<std::string> own_attributes;
  std::vector<GltfValues> own;  // their values, as far as the buffers have them
};

// Checks a file and returns the contents that its JSON declares; an empty GltfPromise for any
// version but glTF 2, which is left to assimp. `file`: a whole .gltf or .glb file. `buffers`: the
// file's buffers; `own` of the result refers to them. assimp 5.2 drops triangles whose indices are
// out of range, so it may deliver fewer triangles than declared. May throw std::bad_alloc. Errors,
// without the file's name: kMalformed (no JSON, or JSON of another form), kUnsupported (a required
// extension that is not supported; coordinates or weights that are not floats, whose bytes assimp
// 5.2 would copy as floats).
Result<GltfPromise> checkGltf(std::string_view file, GltfBuffers& buffers);

}  // namespace merlin::render::import
