// Image: RGBA pixels in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace merlin::render {

struct Image {
  int width = 0, height = 0;         // [px]
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom

  // Puts `right` beside it. REQUIRES: of the same height, unless this one is empty.
  void append(const Image& right);
};

}  // namespace merlin::render
