// StoredImage: the pixels of a file as they are stored, with the file's header. Private to
// render/range/io.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/range/io/image_header.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

struct StoredImage {
  std::size_t width = 0, height = 0;
  std::size_t channels = 1;     // 1, or 3: red, green, blue
  double largest = 0;           // largest value that the file can store; 0: values have no scale
  std::vector<float> values{};  // pixels x channels, rows from top to bottom
  ImageHeader header{};
  std::vector<Plane> planes{};  // further images in the same file
  std::vector<std::string> notes{};
};

}  // namespace merlin::render::range
