// Which vertices lie in one place: the two sides of a seam, what splitNonManifold() has split, and
// soups whose triangles share nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render {

// A ring through the vertices of each place, in the order of their numbers: of v the next one; v
// itself where it is alone. Places are equal where all coordinates are (so -0 is 0).
// positions  vertices x 3, none of them NaN. O(n) as a rule, by a hash table; O(n log n) where
//            places were chosen to meet there. Reentrant.
std::vector<std::uint32_t> samePlace(std::span<const float> positions);

// The same, always O(n log n).
std::vector<std::uint32_t> samePlaceBySorting(std::span<const float> positions);

}  // namespace merlin::render
