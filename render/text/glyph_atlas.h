// GlyphAtlas: holds pictures of all characters of a font that MERLIN draws, in all sizes in use, in
// one picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::text {

struct Glyph {
  int x = 0, y = 0, width = 0, height = 0;  // place of the glyph's picture in the atlas [px]
  int left = 0;                             // from the pen to the picture's left edge [px]
  int top = 0;                              // from the base line up to its upper edge [px]
  int advance = 0;                          // from the pen to the pen of the next character [px]
};

struct FontSize {
  int em_px = 0;                      // as requested
  int ascent_px = 0, descent_px = 0;  // of the font, from the base line; both positive
};

// Characters: Latin with its extensions A and B, Greek, Cyrillic, and some punctuation and symbols,
// as far as the font has them. The same font gives the same bytes. Reentrant; immutable.
class GlyphAtlas {
 public:
  // `font`: a font file that FreeType reads; used only during the call. `sizes_px`: em sizes. Costs
  // about 50 us for each character and size. Errors: kMalformed (FreeType cannot read the font).
  // REQUIRES: 1 <= size <= 200.
  static Result<GlyphAtlas> make(std::span<const std::byte> font, std::span<const int> sizes_px);

  // `size`: index in `sizes_px`.
  const FontSize& size(std::size_t size) const noexcept { return sizes_[size]; }
  // Returns the glyph of a character; a box if the atlas lacks it. Costs O(log n).
  const Glyph& glyph(std::size_t size, char32_t character) const noexcept;
  bool has(char32_t character) const noexcept;

  // Returns the coverage, 0..255, of each pixel of one row of the glyph's picture. `row`: counted
  // from the top.
  std::span<const std::uint8_t> row(const Glyph& glyph, int row) const noexcept;

  // Returns the size of the atlas's picture [bytes].
  std::size_t bytes() const noexcept { return coverage_.size(); }

 private:
  GlyphAtlas() = default;

  class Builder;

  std::vector<char32_t> characters_;  // ascending
  // For each size, one after another: the glyphs of characters_, then the box.
  std::vector<Glyph> glyphs_;
  std::vector<FontSize> sizes_;
  std::vector<std::uint8_t> coverage_;
};

}  // namespace merlin::render::text
