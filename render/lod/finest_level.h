// The finest level of a model: makes a model that has only this level, and finds its bounding box.
#pragma once

#include "render/lod/dendrogram.h"
#include "render/mesh/mesh.h"

namespace merlin::render::lod {

// Makes a model with one level, the mesh itself. REQUIRES: as buildDendrogram().
Dendrogram oneLevel(const mesh::Mesh& mesh);

// Bounding box of the corners of the finest level's triangles; of all positions if it has no
// triangle. Linear.
mesh::Box finestBox(const Dendrogram& model);

}  // namespace merlin::render::lod
