// Colours of a file whose format does not say whether they are fractions or bytes. Private to
// render/mesh/io.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace merlin::render::mesh {

// Makes fractions of the colours of a whole file if they are bytes, 0 to 255. Fractions reach 1, or
// somewhat more where something is brighter than white; bytes that reach no more than 2 are black.
inline void makeFractions(std::vector<float>& colours) {
  constexpr float kMostFraction = 2, kMostByte = 255;
  float most = 0;
  for (const float c : colours) most = std::max(most, c);
  if (most <= kMostFraction) return;
  for (float& c : colours) c /= kMostByte;
}

// Of a triangle to which the file gives no colour.
inline constexpr float kNoColour = std::numeric_limits<float>::quiet_NaN();

// Completes the colours of a file's facets, of which those behind the last coloured one are
// missing: fractions, and white for those that have none. `colours` stays empty if it is.
inline void completeFacetColours(std::size_t triangles, std::vector<float>& colours) {
  if (colours.empty()) return;
  makeFractions(colours);
  colours.resize(3 * triangles, kNoColour);
  std::ranges::replace_if(
      colours, [](float c) { return std::isnan(c); }, 1.0F);
}

}  // namespace merlin::render::mesh
