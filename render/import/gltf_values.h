// Reads the vertex attributes of a .glb file that glTF does not define, since assimp skips them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "render/mesh/mesh.h"

namespace merlin::render::import {

// Values of the file's only primitive. All empty if nothing can be read.
struct GltfValues {
  std::vector<float> positions;  // vertices x 3, to match them with another reader's
  // For example "heat" from the attribute "_heat"; also "colour" (3, proportional to light) if
  // MERLIN wrote the file with a texture. May contain NaN.
  std::vector<mesh::Feature> features;
};

// Reads the vertex attributes of floats whose names begin with "_". They must be stored as in a GLB
// that MERLIN wrote: in the binary chunk of a file in which only one node has a mesh, with a single
// primitive. All others are ignored; the caller may add a note about them. `model`: the JSON of
// `glb`, a whole .glb file of version 2. Each offset and count is checked against the chunk. May
// throw std::bad_alloc.
GltfValues ownValuesOf(const nlohmann::json& model, std::string_view glb);

// Returns for each row of the features the index of the first row with the same values. O(n log n).
// REQUIRES: no value is NaN, and each feature has `rows` rows.
std::vector<std::uint32_t> firstEqualRows(const std::vector<mesh::Feature>& features,
                                          std::size_t rows);

}  // namespace merlin::render::import
