#include "render/out/picture/picture_digest.h"

#include <bit>
#include <cassert>
#include <cstring>

namespace merlin::render::out {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are read as little-endian words");

constexpr std::size_t kPixel = 4;

// Returns a pixel with red in the lowest byte, whatever the order in memory; the fourth byte is 0.
template <PixelOrder order>
std::uint32_t pixelAt(const std::uint8_t* at) noexcept {
  std::uint32_t word = 0;
  std::memcpy(&word, at, sizeof word);
  if constexpr (order == PixelOrder::kRgba) return word & 0xFFFFFFU;
  return (word & 0xFFU) << 16U | (word & 0xFF00U) | (word >> 16U & 0xFFU);
}

// Each pixel has an odd weight of its own, so that pixels that change places are noticed.
template <PixelOrder order>
void addRow(const std::uint8_t* row, std::size_t width, std::span<std::uint32_t> cells,
            std::uint32_t& lit_bits) noexcept {
  for (std::size_t c = 0; c < PictureDigest::kColumns; ++c) {
    const std::size_t from = c * width / PictureDigest::kColumns;
    const std::size_t to = (c + 1) * width / PictureDigest::kColumns;
    std::uint32_t sum = 0, bits = 0;
    for (std::size_t x = from; x < to; ++x) {
      const std::uint32_t pixel = pixelAt<order>(row + kPixel * x);
      sum += pixel * static_cast<std::uint32_t>(2 * x + 1);
      bits |= pixel;
    }
    cells[c] = sum;
    lit_bits |= bits;
  }
}

}  // namespace

PictureDigest digestOf(const PixelRows& picture) noexcept {
  PictureDigest digest{};
  const auto width = static_cast<std::size_t>(picture.width);
  if (picture.width <= 0 || picture.height <= 0) return digest;
  const auto rows = digestRows(picture.height);
  assert(picture.pixels.size() >=
         static_cast<std::size_t>(picture.height - 1) * picture.pitch + kPixel * width);
  for (std::size_t r = 0; r < PictureDigest::kRows; ++r) {
    const std::uint8_t* const row =
        picture.pixels.data() + static_cast<std::size_t>(rows[r]) * picture.pitch;
    const auto cells =
        std::span(digest.cells).subspan(r * PictureDigest::kColumns, PictureDigest::kColumns);
    if (picture.order == PixelOrder::kRgba)
      addRow<PixelOrder::kRgba>(row, width, cells, digest.lit_bits);
    else
      addRow<PixelOrder::kBgrx>(row, width, cells, digest.lit_bits);
  }
  return digest;
}

}  // namespace merlin::render::out
