// fit(): where a picture lies in a window. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

namespace merlin::render::out {

struct PixelSize {
  int width = 0, height = 0;
};

struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelRectangle&) const = default;
};

// Returns the rectangle that the whole picture covers in the middle of the window [px]. `scaled`:
// the largest rectangle that fits and has the picture's proportions; otherwise it has the picture's
// own size, which may be larger than the window. REQUIRES: all sizes are positive.
inline PixelRectangle fit(const PixelSize& picture, const PixelSize& window, bool scaled) {
  PixelSize size = picture;
  if (scaled) {
    const std::int64_t across = std::int64_t{window.width} * picture.height;
    const std::int64_t along = std::int64_t{window.height} * picture.width;
    const auto rounded = [](std::int64_t over, std::int64_t under) {
      return std::max(1, static_cast<int>((2 * over + under) / (2 * under)));
    };
    if (across <= along)
      size = {window.width, rounded(across, picture.width)};
    else
      size = {rounded(along, picture.height), window.height};
  }
  return {(window.width - size.width) / 2, (window.height - size.height) / 2, size.width,
          size.height};
}

}  // namespace merlin::render::out
