// Colours of a file whose format does not say whether they are fractions or bytes. Private to
// render/mesh/io.
#pragma once

#include <algorithm>
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

}  // namespace merlin::render::mesh
