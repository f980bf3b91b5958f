// Finds coincident vertices: the two sides of a texture seam, the copies that splitNonManifold()
// makes, and triangle soups whose triangles share no vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render::mesh {

// Links coincident vertices into rings. Entry v is the next higher index of a vertex at the
// position of v; the highest index is followed by the lowest. A vertex that is alone at its
// position is followed by itself. Positions are equal if all coordinates are equal (-0 equals 0).
//   positions  vertices x 3, none of them NaN
// Expected O(n), with a hash table; O(n log n) if positions were crafted to collide. Reentrant.
std::vector<std::uint32_t> coincidentVertices(std::span<const float> positions);

// Same result as coincidentVertices(), always in O(n log n).
std::vector<std::uint32_t> coincidentVerticesBySorting(std::span<const float> positions);

}  // namespace merlin::render::mesh
