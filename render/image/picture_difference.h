// PictureDifference: finds the pixels in which two images differ visibly. Pure.
#pragma once

#include <array>

#include "render/image/image.h"

namespace merlin::render::image {

// Difference of two images of equal size. A pixel counts as changed if a channel differs by more
// than 15 % of its range ([GOURLEY98] figures 5.30 to 5.35).
struct PictureDifference {
  Image image;  // changed pixels white, the others black; alpha 0
  // Number of changed pixels, in percent of the pixels that differ from `background` in at least
  // one of the images.
  double changed_percent = 0;
};

// Compares two images. `background`: red, green, blue, each 0..1. REQUIRES: `a` and `b` have the
// same size.
PictureDifference differenceOf(const Image& a, const Image& b,
                               const std::array<float, 3>& background);

}  // namespace merlin::render::image
