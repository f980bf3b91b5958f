// Geometry of range images: points from ranges.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/range/range_image.h"
#include "render/range/work.h"

namespace merlin::render::range {

// A fault of the image's geometry as a sentence that says what is missing or wrong and how to give
// it; empty if points can be made.
std::string faultOf(const RangeImage& image);

// The points of the image in world coordinates: pixels x 3, NaN where there is no return.
// O(pixels). REQUIRES: faultOf(image) is empty.
std::vector<float> pointsOf(const RangeImage& image, const Work& work);

// Rows at equal steps of altitude over an angle, the top one first, for a spinning scanner.
std::vector<Beam> evenBeams(double vertical_rad, std::size_t rows);

// Typical angle between the rays of neighbouring pixels, the larger one of those along rows and
// those along columns: medians of up to 4096 pairs each [rad]; 0 for kElevation, or if no two rays
// are neighbours. O(1). REQUIRES: faultOf(image) is empty.
double stepOf(const RangeImage& image);

// kRays only: whether the columns run to the left as the scanner sees it, so that triangles need
// the other order to face it. O(pixels).
bool isMirrored(const RangeImage& image);

}  // namespace merlin::render::range
