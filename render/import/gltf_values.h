// The values of vertices in a .glb file that glTF does not define, which assimp does not read.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "render/mesh/mesh.h"

namespace merlin::render::import {

// Of the file's only primitive. All empty if nothing of it can be read.
struct GltfValues {
  std::vector<float> positions;  // vertices x 3, by which another reader's are compared
  // "heat" of "_heat", and "colour" (3, proportional to light) of a textured file of MERLIN's own;
  // may hold what is no number.
  std::vector<mesh::Feature> features;
};

// The attributes of floats, one a vertex, whose names begin with "_", as a GLB that MERLIN wrote
// has them: in the binary chunk, of a file whose single node with a mesh shows a single primitive.
// All others are left to the caller's note. `model`: the JSON of `glb`, a whole .glb file of
// version 2. Each offset and count is checked against the chunk. May throw std::bad_alloc.
GltfValues ownValuesOf(const nlohmann::json& model, std::string_view glb);

// For each row of the features, the first row that has the same values. O(n log n). REQUIRES: no
// value is NaN, and each feature has `rows` rows.
std::vector<std::uint32_t> firstEqualRows(const std::vector<mesh::Feature>& features,
                                          std::size_t rows);

}  // namespace merlin::render::import
