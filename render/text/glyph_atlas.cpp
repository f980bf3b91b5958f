#include "render/text/glyph_atlas.h"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H

namespace merlin::render::text {
namespace {

constexpr int kWidth_px = 1024;  // width of the atlas's picture

struct Range {
  char32_t first, last;
};
constexpr Range kRanges[] = {{0x20, 0x7E},     {0xA0, 0x24F},    {0x370, 0x3FF},   {0x400, 0x52F},
                             {0x2010, 0x2027}, {0x2030, 0x203A}, {0x20A0, 0x20BF}, {0x2100, 0x214F},
                             {0x2190, 0x2199}, {0x2200, 0x2265}, {0x25A0, 0x25CF}};

struct Close {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
using Library = std::unique_ptr<std::remove_pointer_t<FT_Library>, Close>;
using Face = std::unique_ptr<std::remove_pointer_t<FT_Face>, Close>;

int pixels(FT_Pos in_64ths) { return static_cast<int>((in_64ths + 32) >> 6); }

}  // namespace

// Draws glyphs and puts their pictures side by side, row by row.
class GlyphAtlas::Builder {
 public:
  explicit Builder(FT_Face face) : face_(face) {}

  Result<Ok> addSize(int em_px) {
    if (FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(em_px)) != 0)
      return Error{Errc::kMalformed, fmt::format("the font has no size of {} pixels", em_px)};
    const FT_Size_Metrics& metrics = face_->size->metrics;
    atlas_.sizes_.push_back({em_px, pixels(metrics.ascender), -pixels(metrics.descender)});
    for (const char32_t character : atlas_.characters_) {
      if (FT_Load_Char(face_, character, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0)
        return Error{Errc::kMalformed,
                     fmt::format("the font's character U+{:04X} cannot be drawn with {} pixels",
                                 static_cast<std::uint32_t>(character), em_px)};
      addGlyph(*face_->glyph);
    }
    addBox(em_px);
    return Ok{};
  }

  void findCharacters() {
    for (const Range& range : kRanges) {
      for (char32_t c = range.first; c <= range.last; ++c) {
        if (FT_Get_Char_Index(face_, c) != 0) atlas_.characters_.push_back(c);
      }
    }
  }

  GlyphAtlas take() { return std::move(atlas_); }

 private:
  void addGlyph(const FT_GlyphSlotRec_& slot) {
    const FT_Bitmap& bitmap = slot.bitmap;
    Glyph glyph{.width = static_cast<int>(bitmap.width),
                .height = static_cast<int>(bitmap.rows),
                .left = slot.bitmap_left,
                .top = slot.bitmap_top,
                .advance = pixels(slot.advance.x)};
    place(glyph);
    for (int y = 0; y < glyph.height; ++y)
      std::copy_n(bitmap.buffer + std::ptrdiff_t{y} * bitmap.pitch, glyph.width, rowOf(glyph, y));
    atlas_.glyphs_.push_back(glyph);
  }

  // Adds the outline of a box that is as high as a capital letter.
  void addBox(int em_px) {
    const int height = std::max(em_px * 3 / 4, 3), line = std::max(em_px / 14, 1);
    Glyph glyph{.width = std::max(em_px / 2, 3),
                .height = height,
                .left = line,
                .top = height,
                .advance = std::max(em_px / 2, 3) + 2 * line};
    place(glyph);
    for (int y = 0; y < glyph.height; ++y) {
      const bool whole = y < line || y >= glyph.height - line;
      std::uint8_t* const row = rowOf(glyph, y);
      std::fill_n(row, whole ? glyph.width : line, std::uint8_t{255});
      std::fill_n(row + glyph.width - line, line, std::uint8_t{255});
    }
    atlas_.glyphs_.push_back(glyph);
  }

  void place(Glyph& glyph) {
    if (x_ + glyph.width > kWidth_px) {
      y_ += row_height_;
      x_ = row_height_ = 0;
    }
    glyph.x = std::exchange(x_, x_ + glyph.width);
    glyph.y = y_;
    row_height_ = std::max(row_height_, glyph.height);
    atlas_.coverage_.resize(static_cast<std::size_t>(kWidth_px) *
                            static_cast<std::size_t>(y_ + row_height_));
  }

  std::uint8_t* rowOf(const Glyph& glyph, int y) {
    return atlas_.coverage_.data() + static_cast<std::ptrdiff_t>(kWidth_px) * (glyph.y + y) +
           glyph.x;
  }

  FT_Face face_;
  GlyphAtlas atlas_;
  int x_ = 0, y_ = 0, row_height_ = 0;
};

Result<GlyphAtlas> GlyphAtlas::make(std::span<const std::byte> font,
                                    std::span<const int> sizes_px) {
  FT_Library opened = nullptr;
  if (FT_Init_FreeType(&opened) != 0)
    return Error{Errc::kMalformed, "FreeType cannot be used: it has no memory"};
  const Library library(opened);
  FT_Face read = nullptr;
  const auto* const bytes = reinterpret_cast<const FT_Byte*>(font.data());
  if (const int fault =
          FT_New_Memory_Face(opened, bytes, static_cast<FT_Long>(font.size()), 0, &read);
      fault != 0)
    return Error{Errc::kMalformed,
                 fmt::format("the font of {} bytes cannot be read (FreeType's error {})",
                             font.size(), fault)};
  const Face face(read);
  Builder builder(read);
  builder.findCharacters();
  for (const int size : sizes_px) {
    if (const auto added = builder.addSize(size); !added) return added.error();
  }
  return builder.take();
}

const Glyph& GlyphAtlas::glyph(std::size_t size, char32_t character) const noexcept {
  const auto found = std::ranges::lower_bound(characters_, character);
  const auto index = found != characters_.end() && *found == character
                         ? static_cast<std::size_t>(found - characters_.begin())
                         : characters_.size();
  return glyphs_[size * (characters_.size() + 1) + index];
}

bool GlyphAtlas::has(char32_t character) const noexcept {
  return std::ranges::binary_search(characters_, character);
}

std::span<const std::uint8_t> GlyphAtlas::row(const Glyph& glyph, int row) const noexcept {
  const auto at = static_cast<std::size_t>(kWidth_px) * static_cast<std::size_t>(glyph.y + row) +
                  static_cast<std::size_t>(glyph.x);
  return std::span(coverage_).subspan(at, static_cast<std::size_t>(glyph.width));
}

}  // namespace merlin::render::text
