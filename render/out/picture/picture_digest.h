// PictureDigest: what is kept of a picture to tell later whether another one is the same. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::out {

// Checksums of 24 rows that are evenly spread over the picture, each row in 32 pieces. Differences
// only in the rows between them are not noticed. Trivial, so that a SeqSlot holds it: begin with
// PictureDigest{}.
struct PictureDigest {
  static constexpr std::size_t kRows = 24, kColumns = 32, kCells = kRows * kColumns;

  std::array<std::uint32_t, kCells> cells;
  std::uint32_t lit_bits;  // bitwise OR of these rows' pixels: red, green, blue from bit 0

  // True if no channel of any pixel read reaches 8 of 255.
  bool isBlack() const noexcept { return (lit_bits & 0xF8F8F8U) == 0; }
  bool operator==(const PictureDigest&) const = default;
};

// The rows of a picture of this height [px] that digestOf() reads, from top to bottom; a low
// picture's may occur twice.
constexpr std::array<int, PictureDigest::kRows> digestRows(int height) noexcept {
  std::array<int, PictureDigest::kRows> rows{};
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r] = static_cast<int>((2 * r + 1) * static_cast<std::size_t>(height) / (2 * rows.size()));
  return rows;
}

// The bytes of a pixel, first to last; the fourth one is not looked at.
enum class PixelOrder { kRgba, kBgrx };

// A picture in memory, rows from top to bottom.
struct PixelRows {
  int width = 0, height = 0;               // [px]
  std::span<const std::uint8_t> pixels{};  // from the first pixel on
  std::size_t pitch = 0;                   // [bytes] from one row to the next
  PixelOrder order = PixelOrder::kRgba;
};

// Returns the same digest for the same picture in either order of bytes. REQUIRES: `pixels` holds
// all rows. Cost: one pass over 24 rows. Reentrant.
PictureDigest digestOf(const PixelRows& picture) noexcept;

}  // namespace merlin::render::out
