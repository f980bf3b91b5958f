// Finds coincident vertices, i.e. vertices at the same position: the two sides of a texture seam,
// the copies that splitNonManifold() makes, and triangle soups whose triangles share no vertices.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render::mesh {

// Returns a hash of the bits of a position (3 floats). Coordinates that compare equal have the same
// hash; -0 is converted to 0 by adding 0.
inline std::uint64_t hashOfPlace(const float* position) noexcept {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ std::bit_cast<std::uint32_t>(position[k] + 0.0F)) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

// Links coincident vertices into rings. Entry v is the next higher index of a vertex at the
// position of v; the highest index is followed by the lowest. A vertex that is alone at its
// position is followed by itself. Positions are equal if all coordinates are equal (-0 equals 0).
//   positions  vertices x 3, none of them NaN
// Expected O(n), with a hash table; O(n log n) if positions were crafted to collide. Reentrant.
std::vector<std::uint32_t> coincidentVertices(std::span<const float> positions);

// Returns the maximum memory that coincidentVertices() takes, including its result [bytes]: 12 to
// 20 bytes per vertex.
std::size_t bytesForCoincident(std::size_t vertices);

// Returns the same as coincidentVertices(), always in O(n log n).
std::vector<std::uint32_t> coincidentVerticesBySorting(std::span<const float> positions);

}  // namespace merlin::render::mesh
