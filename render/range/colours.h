// Colours of a plane's values, for features that a viewer shows at once.
#pragma once

#include <span>

#include "render/range/range_image.h"

namespace merlin::render::range {

enum class Scale {
  kBlueToRed,  // low blue, then cyan, green, yellow, high red: confidence as in [GOURLEY98] 5.2.4
  kTerrain     // low green, then yellow, brown, high white: heights
};

struct Ends {
  float low = 0, high = 0;
};

// The smallest and the largest finite value; both 0 if there is none.
Ends endsOf(std::span<const float> values) noexcept;

// A plane "colour" of dimension 3, each 0..1: `values`, one per pixel, on a scale from `ends.low`
// to `ends.high`. Values outside have the colour of the nearer end, those that are not numbers that
// of the lower one; equal ends give the middle of the scale. O(values).
Plane coloursOf(std::span<const float> values, Ends ends, Scale scale);

}  // namespace merlin::render::range
