// Threshold: a limit of a length; it is a fixed length, a share of the range, or the smaller one of
// both.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace merlin::render::range {

struct Threshold {
  float length = std::numeric_limits<float>::infinity();     // [units]
  float per_range = std::numeric_limits<float>::infinity();  // share of the range; 0.01 means 1 %

  // Returns the limit at this range: the fixed length or the share of the range, whichever is
  // smaller [units].
  float at(float range) const noexcept {
    // Avoids infinity * 0, which is NaN.
    const float relative = std::isinf(per_range) ? per_range : per_range * std::abs(range);
    return std::min(length, relative);
  }
};

}  // namespace merlin::render::range
