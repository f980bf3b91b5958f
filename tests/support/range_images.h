// Synthetic range images for tests.
#pragma once

#include <cmath>
#include <numbers>

#include "daemon/base/random.h"
#include "render/range/range_image.h"

namespace merlin::test {

// Returns an image whose ranges are all 1. kOrthogonal: the field of view is 90 x 90 degrees.
// kElevation: the cells are 1 x 1.
inline render::range::RangeImage flatImage(std::size_t width, std::size_t height,
                                           render::range::Scanner scanner) {
  render::range::RangeImage image;
  image.width = width;
  image.height = height;
  image.range.assign(width * height, 1.0F);
  image.geometry.scanner = scanner;
  image.geometry.horizontal_rad = image.geometry.vertical_rad = std::numbers::pi / 2;
  return image;
}

// Returns a full turn of a scanner inside a cylinder of radius about 1.
inline render::range::RangeImage ring(std::size_t width, std::size_t height) {
  render::range::RangeImage image = flatImage(width, height, render::range::Scanner::kSpinning);
  image.geometry.horizontal_rad = 2 * std::numbers::pi;
  for (std::size_t r = 0; r < height; ++r)
    image.geometry.beams.push_back({0.2 - 0.2 * static_cast<double>(r), 0});
  return image;
}

// Returns an image of the plane z = -1, seen from the origin; if `mirrored`, its columns run to the
// left.
inline render::range::RangeImage rays(std::size_t width, std::size_t height, bool mirrored) {
  render::range::RangeImage image = flatImage(width, height, render::range::Scanner::kRays);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    const float x = 0.1F * static_cast<float>(p % width) - 0.3F;
    const float y = 0.3F - 0.1F * static_cast<float>(p / width);
    image.range[p] = std::sqrt(1 + x * x + y * y);
    for (const float k : {mirrored ? -x : x, y, -1.0F})
      image.geometry.rays.push_back(k / image.range[p]);
  }
  return image;
}

// Returns an image of a wavy surface 2 to 4 units away, with noise, a step, spikes and pixels
// without a return.
inline render::range::RangeImage bumps(std::size_t width, std::size_t height) {
  render::range::RangeImage image = flatImage(width, height, render::range::Scanner::kOrthogonal);
  Random random(7);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    const double x = static_cast<double>(p % width), y = static_cast<double>(p / width);
    double r = 2 + 0.1 * std::sin(x / 9) + 0.1 * std::cos(y / 7) + 0.01 * random.normal();
    if (x > 0.7 * static_cast<double>(width)) r += 1;
    if (p % 97 == 3) r += 0.7;
    image.range[p] = p % 53 == 1 ? render::range::kNoReturn : static_cast<float>(r);
  }
  return image;
}

}  // namespace merlin::test
