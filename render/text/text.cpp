#include "render/text/text.h"

#include "daemon/base/utf8.h"

namespace merlin::render::text {
namespace {

constexpr int kWidest_px = 1'000'000;
constexpr std::string_view kEllipsis = "\u2026";

// Returns the longest beginning of `text` that takes at most `width_px`.
std::string_view beginning(const Font& font, std::string_view text, int width_px) {
  std::string_view rest = text;
  for (int width = 0; !rest.empty();) {
    std::string_view after = rest;
    width += font.atlas->glyph(font.size, takeCharacter(after)).advance;
    if (width > width_px) break;
    rest = after;
  }
  return text.substr(0, text.size() - rest.size());
}

void drawGlyph(const Surface& surface, const Font& font, const Glyph& glyph, Point pen,
               Colour colour) {
  for (int y = 0; y < glyph.height; ++y)
    surface.coverRow({pen.x + glyph.left, pen.y - glyph.top + y}, font.atlas->row(glyph, y),
                     colour);
}

}  // namespace

int textWidth(const Font& font, std::string_view text) noexcept {
  int width = 0;
  while (!text.empty() && width < kWidest_px)
    width += font.atlas->glyph(font.size, takeCharacter(text)).advance;
  return width;
}

Point drawText(const Surface& surface, const Font& font, Point pen, std::string_view text,
               Colour colour) noexcept {
  // The margin of one em allows for glyphs that begin to the left of their pen.
  const int end = surface.clip().x + surface.clip().width + font.metrics().em_px;
  while (!text.empty() && pen.x < end) {
    const Glyph& glyph = font.atlas->glyph(font.size, takeCharacter(text));
    drawGlyph(surface, font, glyph, pen, colour);
    pen.x += glyph.advance;
  }
  return pen;
}

// A font's ascent includes accents over capitals, so the text is not centred by it: letters look
// central if their base line is 36 % of the em size below the middle.
int drawTextIn(const Surface& surface, const Font& font, const Rect& box, std::string_view text,
               Colour colour, Align align) noexcept {
  const Surface clipped = surface.clippedTo(box);
  const int width = textWidth(font, text);
  Point pen{box.x, box.y + (box.height + font.metrics().em_px * 72 / 100) / 2};
  if (width > box.width) {
    const int ellipsis = textWidth(font, kEllipsis);
    pen = drawText(clipped, font, pen, beginning(font, text, box.width - ellipsis), colour);
    return drawText(clipped, font, pen, kEllipsis, colour).x - box.x;
  }
  if (align == Align::kMiddle) pen.x += (box.width - width) / 2;
  if (align == Align::kRight) pen.x += box.width - width;
  drawText(clipped, font, pen, text, colour);
  return width;
}

}  // namespace merlin::render::text
