#include "render/text/plate_cover.h"

#include <algorithm>

namespace merlin::render::text {
namespace {

// Blends `over`, which is premultiplied, onto as many bytes of `under`. Computes with 16 bits, so
// that the compiler uses vector instructions.
void blendRow(std::span<const std::uint8_t> over, std::uint8_t* __restrict under) {
  const std::uint8_t* __restrict const from = over.data();
  for (std::size_t i = 0; i + 4 <= over.size(); i += 4) {
    const auto rest = static_cast<std::uint16_t>(255 - from[i + 3]);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto x = static_cast<std::uint16_t>(under[i + c] * rest + 128);
      const auto share = static_cast<std::uint16_t>((x + (x >> 8)) >> 8);
      under[i + c] = static_cast<std::uint8_t>(from[i + c] + share);
    }
  }
}

std::size_t bytesOf(const Rect& at) {
  return std::size_t{4} * static_cast<std::size_t>(at.width) * static_cast<std::size_t>(at.height);
}

}  // namespace

// Calls act(offset in the canvas, offset in the plate, bytes) for each row of a plate.
template <typename Act>
void PlateCover::forEachRow(const Rect& at, const Act& act) const {
  const std::size_t bytes = 4 * static_cast<std::size_t>(at.width);
  for (int y = 0; y < at.height; ++y) {
    const auto row = static_cast<std::size_t>(at.y + y);
    act(4 * (row * width_ + static_cast<std::size_t>(at.x)), static_cast<std::size_t>(y) * bytes,
        bytes);
  }
}

void PlateCover::put(const Plate& plate, const Rect& tile, std::span<std::uint8_t> canvas) {
  put_.push_back({tile.x + plate.at.x, tile.y + plate.at.y, plate.at.width, plate.at.height});
  forEachRow(put_.back(), [&](std::size_t at, std::size_t from, std::size_t bytes) {
    const auto under = canvas.subspan(at, bytes);
    covered_.insert(covered_.end(), under.begin(), under.end());
    blendRow(std::span(plate.rgba).subspan(from, bytes), under.data());
  });
}

// Restores the last plate first, since plates of a low tile may overlap.
void PlateCover::erase(std::span<std::uint8_t> canvas) {
  std::size_t end = covered_.size();
  for (auto rect = put_.rbegin(); rect != put_.rend(); ++rect) {
    end -= bytesOf(*rect);
    forEachRow(*rect, [&](std::size_t at, std::size_t from, std::size_t bytes) {
      std::copy_n(&covered_[end + from], bytes, &canvas[at]);
    });
  }
  put_.clear();
  covered_.clear();
}

}  // namespace merlin::render::text
