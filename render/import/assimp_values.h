// Matches the vertex values of a glTF file that assimp does not read with assimp's meshes.
#pragma once

#include <cstddef>
#include <vector>

#include "render/import/gltf_check.h"
#include "render/mesh/mesh.h"

struct aiScene;

namespace merlin::render::import {

// Values of the vertices of all meshes with triangles, one mesh after the other.
struct OwnValues {
  std::vector<mesh::Feature> features{};  // empty if there are none; may contain NaN
  std::size_t rows = 0;                   // of each feature
  std::vector<std::size_t> first_rows{};  // by mesh: the row of its first vertex
};

// Takes the features that all meshes with triangles have; colours stay proportional to light. A
// mesh is matched with the primitive whose vertices are at the same places in the same order; if
// several are there whose values differ, or none is, nothing is taken. Removes what it takes from
// `own_attributes`. REQUIRES: the buffers of the promise are still there. May throw std::bad_alloc.
OwnValues takeOwnValues(GltfPromise& promised, const aiScene& scene);

}  // namespace merlin::render::import
