// Converts a plane's values to colours, which viewers show without further settings.
#pragma once

#include <span>

#include "render/range/range_image.h"

namespace merlin::render::range {

enum class Scale {
  kBlueToRed,  // low: blue, then cyan, green, yellow; high: red. For confidence, [GOURLEY98] 5.2.4
  kTerrain     // low: green, then yellow, brown; high: white. For heights
};

struct Ends {
  float low = 0, high = 0;
};

// The smallest and the largest finite value; both 0 if there is none.
Ends endsOf(std::span<const float> values) noexcept;

// Returns a plane "colour" of dimension 3, each 0..1: for each of `values`, one per pixel, its
// colour on a scale from `ends.low` to `ends.high`. Values outside get the colour of the nearer
// end, values that are not numbers that of the lower end; if both ends are equal, all values get
// the middle of the scale. O(values).
Plane coloursOf(std::span<const float> values, Ends ends, Scale scale);

}  // namespace merlin::render::range
