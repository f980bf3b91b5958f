// Threshold: a length, a share of the range, or both.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace merlin::render::range {

struct Threshold {
  float length = std::numeric_limits<float>::infinity();     // [units]
  float per_range = std::numeric_limits<float>::infinity();  // share of the range, 0.01 is 1 %

  // The limit at this range: the smaller one of the two [units].
  float at(float range) const noexcept {
    // infinity * 0 would not be a number
    const float relative = std::isinf(per_range) ? per_range : per_range * std::abs(range);
    return std::min(length, relative);
  }
};

}  // namespace merlin::render::range
