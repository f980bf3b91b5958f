// Objects and groups of an OBJ file (o, g) as the feature "label" of its vertices. Private to
// render/mesh/io.
#pragma once

#include <cstdint>
#include <vector>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Adds "label" (1). A vertex has one label, the lowest of its triangles' parts; so the part of a
// triangle is the highest label at its corners, as after weldParts(). Where that would be another
// part's, one corner becomes a vertex of the part's own, at the same place. The surface stays
// connected everywhere else. O(n log n).
// part_of  triangles: the number of each one's part
void labelParts(const std::vector<std::uint32_t>& part_of, Mesh& mesh);

}  // namespace merlin::render::mesh
