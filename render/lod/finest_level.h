// Functions for the finest level of a model: make a model that has only this level, and find its
// bounding box.
#pragma once

#include "render/lod/dendrogram.h"
#include "render/mesh/mesh.h"

namespace merlin::render::lod {

// Makes a model with one level, the mesh itself. REQUIRES: as buildDendrogram().
Dendrogram oneLevel(const mesh::Mesh& mesh);

// Returns the bounding box of the corners of the finest level's triangles; of all positions if the
// model has no triangle. O(triangles).
mesh::Box finestBox(const Dendrogram& model);

}  // namespace merlin::render::lod
