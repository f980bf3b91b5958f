#include "render/image/image.h"

#include <cassert>
#include <cstddef>
#include <utility>

namespace merlin::render::image {

void Image::append(const Image& right) {
  if (pixels.empty()) height = right.height;
  assert(right.height == height);
  std::vector<std::uint8_t> wider;
  wider.reserve(pixels.size() + right.pixels.size());
  const auto row = [](const Image& image, int y) {
    return image.pixels.begin() + std::ptrdiff_t{4} * y * image.width;
  };
  for (int y = 0; y < height; ++y) {
    for (const Image* image : {static_cast<const Image*>(this), &right})
      wider.insert(wider.end(), row(*image, y), row(*image, y + 1));
  }
  pixels = std::move(wider);
  width += right.width;
}

}  // namespace merlin::render::image
