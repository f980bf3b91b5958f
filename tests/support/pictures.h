// RGBA images, with rows from top to bottom, and the comparison of such images.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace merlin::test {

struct Rgba {
  int red = 0, green = 0, blue = 0, alpha = 0;
  friend bool operator==(const Rgba&, const Rgba&) = default;
};

// Returns the largest absolute difference of red, green or blue, 0..255; alpha is ignored.
inline int difference(const Rgba& a, const Rgba& b) {
  return std::max(
      {std::abs(a.red - b.red), std::abs(a.green - b.green), std::abs(a.blue - b.blue)});
}

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  Rgba at(int x, int y) const {
    const std::uint8_t* p = pixels.data() + 4 * (static_cast<std::ptrdiff_t>(y) * width + x);
    return {p[0], p[1], p[2], p[3]};
  }
  // Number of pixels that differ from `background`.
  int covered(const Rgba& background) const {
    int count = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) count += at(x, y) != background;
    }
    return count;
  }
};

// Number of pixels that differ by more than `tolerance` between two images of the same size.
inline int differing(const Image& a, const Image& b, int tolerance) {
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) count += difference(a.at(x, y), b.at(x, y)) > tolerance;
  }
  return count;
}

}  // namespace merlin::test
