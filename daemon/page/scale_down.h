// Makes a picture smaller. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "render/image/image.h"

namespace merlin::page {

// Returns the picture with at most `width` columns and about the same proportions; each new pixel
// is the mean of those that it covers. The height is at most 4 * `width`. A picture within both
// limits is copied. `pixels`: RGBA, 4 * from_width * from_height bytes. O(from_width *
// from_height). REQUIRES: no size is 0.
render::image::Image scaleDown(std::span<const std::uint8_t> pixels, int from_width,
                               int from_height, int width);

}  // namespace merlin::page
