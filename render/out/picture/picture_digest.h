// PictureDigest: checksums of a picture, which tell later whether another picture is the same.
// Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::out {

// Checksums of 24 rows that are evenly spread over the picture, each row in 32 pieces. A difference
// in the rows between them goes unnoticed. A trivial type, so that a SeqSlot can hold it:
// initialise it with PictureDigest{}.
struct PictureDigest {
  static constexpr std::size_t kRows = 24, kColumns = 32, kCells = kRows * kColumns;

  std::array<std::uint32_t, kCells> cells;
  std::uint32_t lit_bits;  // bitwise OR of these rows' pixels: red, green, blue from bit 0

  // Returns true if no channel of any pixel read reaches 8 of 255.
  bool isBlack() const noexcept { return (lit_bits & 0xF8F8F8U) == 0; }
  bool operator==(const PictureDigest&) const = default;
};

// Returns the numbers of the rows that digestOf() reads in a picture of this height [px], from top
// to bottom; with fewer than 24 rows, some occur several times.
constexpr std::array<int, PictureDigest::kRows> digestRows(int height) noexcept {
  std::array<int, PictureDigest::kRows> rows{};
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r] = static_cast<int>((2 * r + 1) * static_cast<std::size_t>(height) / (2 * rows.size()));
  return rows;
}

// The bytes of a pixel, first to last; the fourth one is ignored.
enum class PixelOrder { kRgba, kBgrx };

// A picture in memory, rows from top to bottom.
struct PixelRows {
  int width = 0, height = 0;               // [px]
  std::span<const std::uint8_t> pixels{};  // begins with the first pixel
  std::size_t pitch = 0;                   // [bytes] from one row to the next
  PixelOrder order = PixelOrder::kRgba;
};

// Returns the same digest for the same picture in either order of bytes. REQUIRES: `pixels` holds
// all rows. Cost: one pass over 24 rows. Reentrant.
PictureDigest digestOf(const PixelRows& picture) noexcept;

}  // namespace merlin::render::out
