// Converts a plane's values to colours, which viewers show without further settings.
#pragma once

#include <span>

#include "render/range/range_image.h"

namespace merlin::render::range {

enum class Scale {
  kBlueToRed,  // blue (low), cyan, green, yellow, red (high); for confidence, [GOURLEY98] 5.2.4
  kTerrain     // green (low), yellow, brown, white (high); for heights
};

struct Ends {
  float low = 0, high = 0;
};

// Returns the smallest and the largest finite value; both are 0 if there is none.
Ends endsOf(std::span<const float> values) noexcept;

// Returns a plane "colour" (dimension 3, each 0..1) that shows `values`, one per pixel, on a colour
// scale from `ends.low` to `ends.high`. Values outside the ends get the colour of the nearer end;
// NaN gets the colour of the lower end. If both ends are equal, all values get the middle of the
// scale. O(values).
Plane coloursOf(std::span<const float> values, Ends ends, Scale scale);

}  // namespace merlin::render::range
