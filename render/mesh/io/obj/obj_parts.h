// Converts the objects and groups (o, g) of an OBJ file to the feature "label" of its vertices.
// Private to render/mesh/io.
#pragma once

#include <cstdint>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Adds the feature "label" (1): for each vertex the lowest part number of its triangles. So the
// part of a triangle is the highest label of its corners, as after weldParts(). If no corner of a
// triangle has the label of its part, the first corner is replaced by a copy, at the same position,
// that has this label. The surface stays connected everywhere else. O(n log n).
// `part_of`: for each triangle, the number of its part.
void labelParts(const std::vector<std::uint32_t>& part_of, Mesh& mesh);

}  // namespace merlin::render::mesh
