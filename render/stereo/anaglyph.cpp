#include "render/stereo/anaglyph.h"

#include <cassert>
#include <cstddef>

namespace merlin::render::stereo {

void composeAnaglyph(std::span<const std::uint8_t> left, std::span<const std::uint8_t> right,
                     std::span<std::uint8_t> out) {
  assert(left.size() == right.size() && left.size() == out.size());
  // Weights in 1/256, whose sum is 256, so that white stays white.
  constexpr unsigned kRed = 77, kGreen = 150, kBlue = 29, kHalf = 128;
  for (std::size_t i = 0; i + 4 <= out.size(); i += 4) {
    const unsigned light = kRed * left[i] + kGreen * left[i + 1] + kBlue * left[i + 2] + kHalf;
    out[i] = static_cast<std::uint8_t>(light >> 8);
    out[i + 1] = right[i + 1];
    out[i + 2] = right[i + 2];
    out[i + 3] = 255;
  }
}

}  // namespace merlin::render::stereo
