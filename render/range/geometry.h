// Geometry of range images: computes points from ranges.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/range/range_image.h"
#include "render/range/work.h"

namespace merlin::render::range {

// Returns a sentence that says what is missing or wrong in the image's geometry and how to supply
// it; empty if points can be computed.
std::string faultOf(const RangeImage& image);

// The points of the image in world coordinates: pixels x 3, NaN where there is no return.
// O(pixels). REQUIRES: faultOf(image) is empty.
std::vector<float> pointsOf(const RangeImage& image, const Work& work);

// Returns the beams of a spinning scanner whose rows have equal steps of altitude: the top row
// first, from vertical_rad / 2 above the horizon to as much below it.
std::vector<Beam> evenBeams(double vertical_rad, std::size_t rows);

// Returns the typical angle between the rays of neighbouring pixels [rad]: the larger one of the
// medians along rows and along columns, of up to 4096 pairs each; 0 for kElevation, or if no two
// neighbouring pixels have rays. O(1). REQUIRES: faultOf(image) is empty.
double stepOf(const RangeImage& image);

// For kRays only: whether the columns run from right to left as the scanner sees them; triangles
// then need the reverse order of corners to face the scanner. O(pixels).
bool isMirrored(const RangeImage& image);

}  // namespace merlin::render::range
