// Anaglyph: the two eyes' pictures in one, in red and cyan. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::render::stereo {

// Composes a half-colour anaglyph of two pictures of the same size (RGBA). In each pixel of `out`,
// red is the brightness of the left eye's picture (0.299 red + 0.587 green + 0.114 blue, ITU-R
// BT.601), green and blue are those of the right eye's picture, and alpha is 255. The glasses are
// red on the left eye. `out` may be `left`.
void composeAnaglyph(std::span<const std::uint8_t> left, std::span<const std::uint8_t> right,
                     std::span<std::uint8_t> out);

}  // namespace merlin::render::stereo
