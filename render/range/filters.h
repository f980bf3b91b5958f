// Filters of range images against noise, spikes and outliers. They change ranges only: no pixel
// without a return gets one.
#pragma once

#include <cstddef>

#include "render/range/range_image.h"
#include "render/range/threshold.h"
#include "render/range/work.h"

namespace merlin::render::range {

// Replaces each range by the median of the returns in the window x window pixels around it. If
// their number is even, the lower one of the two middle ranges is taken, so that each result is a
// measured range. Steps between surfaces stay where they are. [GOURLEY98] 5.2.2. O(pixels x
// window^2). REQUIRES: window is odd, 3 to 15.
void medianFilter(RangeImage& image, std::size_t window, const Work& work);

// Removes spikes. A pixel is a spike if fewer than two of its eight neighbours have a range that
// differs from its own by at most the limit (at the smaller one of the two ranges). A pixel at the
// edge of a surface, or on a wire, has two such neighbours and stays. Returns the number of pixels
// that lost their return. O(pixels).
std::size_t removeSpikes(RangeImage& image, const Threshold& limit, const Work& work);

// Removes returns outside [nearest, farthest]. Returns their number. O(pixels).
std::size_t removeOutside(RangeImage& image, float nearest, float farthest);

}  // namespace merlin::render::range
