// Draws text into a surface. Pure.
//
// Text runs from left to right, one character after the other: no kerning, no ligatures, no
// combining marks, no line breaks. A character that the atlas lacks, a control character and a byte
// that is not UTF-8 are drawn as boxes.
#pragma once

#include <string_view>

#include "render/text/glyph_atlas.h"
#include "render/text/surface.h"

namespace merlin::render::text {

// A font in one size. Borrows the atlas.
struct Font {
  const GlyphAtlas* atlas = nullptr;
  std::size_t size = 0;  // index of the atlas's sizes

  const FontSize& metrics() const noexcept { return atlas->size(size); }
};

// Returns the sum of the characters' advances [px]. The sum stops at about a million.
int textWidth(const Font& font, std::string_view text) noexcept;

// Draws from `pen`, which is on the base line. Returns the pen's position after the text; text
// beyond the right edge of the clip is left out.
Point drawText(const Surface& surface, const Font& font, Point pen, std::string_view text,
               Colour colour) noexcept;

enum class Align { kLeft, kMiddle, kRight };

// Draws one line of text in the middle of a box's height; nothing is drawn outside the box. A text
// that is too wide begins at the left edge and ends with an ellipsis. Returns the width that it
// takes [px].
int drawTextIn(const Surface& surface, const Font& font, const Rect& box, std::string_view text,
               Colour colour, Align align = Align::kLeft) noexcept;

}  // namespace merlin::render::text
