// Filters range images to reduce noise, spikes and outliers. The filters never add a return to a
// pixel that has none.
#pragma once

#include <cstddef>

#include "render/range/range_image.h"
#include "render/range/threshold.h"
#include "render/range/work.h"

namespace merlin::render::range {

// Replaces each range by the median of the returns in the window x window pixels around it. If
// their number is even, the result is the lower one of the two middle ranges, so that each result
// is a measured range. Steps between surfaces keep their position. [GOURLEY98] 5.2.2. O(pixels x
// window^2). REQUIRES: window is odd, 3 to 15.
void medianFilter(RangeImage& image, std::size_t window, const Work& work);

// Removes spikes. A pixel is a spike if fewer than two of its eight neighbours have a range that
// differs from its own by at most the limit (at the smaller one of the two ranges). A pixel at the
// edge of a surface, or on a wire, has two such neighbours and stays. Returns the number of pixels
// that lost their return. O(pixels).
std::size_t removeSpikes(RangeImage& image, const Threshold& limit, const Work& work);

// Removes returns whose range is outside [nearest, farthest]; returns their number. O(pixels).
std::size_t removeOutside(RangeImage& image, float nearest, float farthest);

}  // namespace merlin::render::range
