// Converts colours of files whose format does not say whether they are fractions or bytes. Private
// to render/mesh/io.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace merlin::render::mesh {

// Converts all colours of a file to fractions if they are bytes, 0 to 255. They count as bytes if
// any is above 2: fractions hardly exceed 1, even where something is brighter than white, and a
// file whose bytes are all at most 2 would be practically black.
inline void makeFractions(std::vector<float>& colours) {
  constexpr float kMostFraction = 2, kMostByte = 255;
  float most = 0;
  for (const float c : colours) most = std::max(most, c);
  if (most <= kMostFraction) return;
  for (float& c : colours) c /= kMostByte;
}

// Marks a triangle to which the file gives no colour.
inline constexpr float kNoColour = std::numeric_limits<float>::quiet_NaN();

// Completes the colours of a file's facets: converts them to fractions and sets facets without a
// colour to white, including those after the last coloured one, for which `colours` has no entries.
// Empty `colours` stay empty.
inline void completeFacetColours(std::size_t triangles, std::vector<float>& colours) {
  if (colours.empty()) return;
  makeFractions(colours);
  colours.resize(3 * triangles, kNoColour);
  std::ranges::replace_if(
      colours, [](float c) { return std::isnan(c); }, 1.0F);
}

}  // namespace merlin::render::mesh
