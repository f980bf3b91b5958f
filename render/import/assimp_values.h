// Assigns the vertex values of a glTF file that assimp does not read to the vertices of assimp's
// meshes.
#pragma once

#include <cstddef>
#include <vector>

#include "render/import/gltf_check.h"
#include "render/mesh/mesh.h"

struct aiScene;

namespace merlin::render::import {

// The values of the vertices of all meshes with triangles, one mesh after the other.
struct OwnValues {
  std::vector<mesh::Feature> features{};  // empty if there are none; may contain NaN
  std::size_t rows = 0;                   // number of rows of each feature
  std::vector<std::size_t> first_rows{};  // by mesh: index of the row of its first vertex
};

// Returns the features that all meshes with triangles have; colours stay proportional to light. A
// mesh is matched with the primitive whose vertices are at the same positions in the same order. If
// a mesh has no such primitive, or several primitives whose values differ, the result is empty.
// Removes the features that it returns from `own_attributes`. REQUIRES: the buffers to which the
// promise refers still exist. May throw std::bad_alloc.
OwnValues takeOwnValues(GltfPromise& promised, const aiScene& scene);

}  // namespace merlin::render::import
