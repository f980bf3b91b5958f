// Computes points from range images by their geometry.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/range/range_image.h"
#include "render/range/work.h"

namespace merlin::render::range {

// Returns a sentence that explains what is missing or wrong in the image's geometry and how to
// supply it; empty if points can be computed.
std::string faultOf(const RangeImage& image);

// Returns the points of the image in world coordinates: pixels x 3, NaN where there is no return.
// O(pixels). REQUIRES: faultOf(image) is empty.
std::vector<float> pointsOf(const RangeImage& image, const Work& work);

// Returns the beams of a spinning scanner whose rows have equal steps of altitude, the top row
// first: from vertical_rad / 2 above the horizon to vertical_rad / 2 below it.
std::vector<Beam> evenBeams(double vertical_rad, std::size_t rows);

// Returns the typical angle between the rays of neighbouring pixels [rad]: the median along rows or
// the median along columns, whichever is larger, from about 4096 pairs each. Returns 0 for
// kElevation, or if no two neighbouring pixels have rays. O(width + height). REQUIRES:
// faultOf(image) is empty.
double stepOf(const RangeImage& image);

// Returns whether the columns run from right to left as the scanner sees them; triangles then need
// the reverse order of corners to face the scanner. Always false except for kRays. O(pixels).
bool isMirrored(const RangeImage& image);

}  // namespace merlin::render::range
