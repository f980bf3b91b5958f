// Converts colours from file formats that do not specify whether colours are fractions or bytes.
// Private to render/mesh/io.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace merlin::render::mesh {

// Converts the colours of a file to fractions if they are bytes (0 to 255). They count as bytes if
// any value is above 2: fractions hardly exceed 1, even where something is brighter than white, and
// a file whose bytes are all at most 2 would be practically black.
inline void makeFractions(std::vector<float>& colours) {
  constexpr float kMostFraction = 2, kMostByte = 255;
  float most = 0;
  for (const float c : colours) most = std::max(most, c);
  if (most <= kMostFraction) return;
  for (float& c : colours) c /= kMostByte;
}

// Marks a triangle to which the file assigns no colour.
inline constexpr float kNoColour = std::numeric_limits<float>::quiet_NaN();

// Completes the colours of a file's facets: converts them to fractions, appends entries for facets
// after the last coloured one, and sets all facets without a colour to white. Does nothing if
// `colours` is empty. colours: 3 values per facet, kNoColour where a facet has none; triangles:
// number of facets.
inline void completeFacetColours(std::size_t triangles, std::vector<float>& colours) {
  if (colours.empty()) return;
  makeFractions(colours);
  colours.resize(3 * triangles, kNoColour);
  std::ranges::replace_if(
      colours, [](float c) { return std::isnan(c); }, 1.0F);
}

}  // namespace merlin::render::mesh
