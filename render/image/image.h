// Image: RGBA pixels in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace merlin::render::image {

struct Image {
  int width = 0, height = 0;         // [px]
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom

  // Appends `right` at the right edge. REQUIRES: the same height, unless this image is empty.
  void append(const Image& right);
};

}  // namespace merlin::render::image
