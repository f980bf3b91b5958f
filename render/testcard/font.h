// A bitmap font of 8 x 8 pixels for ASCII. Pure.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::render::testcard {

inline constexpr int kGlyphSize = 8;  // [px], with the space to the next one

// Returns the rows of a character from the top; bit i is the pixel of column i. Returns a box for
// any other byte.
std::span<const std::uint8_t, 8> glyph(char c);

}  // namespace merlin::render::testcard
