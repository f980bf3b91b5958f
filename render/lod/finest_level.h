// The finest level of a model: a model that has no other, and the box around it.
#pragma once

#include "render/lod/dendrogram.h"
#include "render/mesh/mesh.h"

namespace merlin::render::lod {

// A model of one level, which is the mesh. REQUIRES: as buildDendrogram().
Dendrogram oneLevel(const mesh::Mesh& mesh);

// Bounding box of the corners of the finest level's triangles; of all positions if it has no
// triangle. Linear.
mesh::Box finestBox(const Dendrogram& model);

}  // namespace merlin::render::lod
