// Finds coincident vertices: the two sides of a texture seam, the copies that splitNonManifold()
// makes, and triangle soups whose triangles share no vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render::mesh {

// Links coincident vertices into rings: entry v is the next vertex by index at the position of v,
// after the last one the first, or v itself if no other vertex is there. Positions are equal if all
// coordinates are (so -0 equals 0).
//   positions  vertices x 3, none of them NaN
// Expected O(n), by a hash table; O(n log n) if positions were crafted to collide. Reentrant.
std::vector<std::uint32_t> coincidentVertices(std::span<const float> positions);

// Same result as coincidentVertices(), always in O(n log n).
std::vector<std::uint32_t> coincidentVerticesBySorting(std::span<const float> positions);

}  // namespace merlin::render::mesh
