#include "render/reduce/quadric/quadric_channels.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::reduce {

void QuadricChannels::mix(std::uint32_t v, std::uint32_t x, const float (&p)[3],
                          const float (&q)[3]) const {
  const float *of_v = block(v), *of_x = block(x);
  const float area = of_v[0] + of_x[0];
  for (std::size_t k = 0; k < count_; ++k) {
    const float *b = of_v + 1 + 4 * k, *c = of_x + 1 + 4 * k;
    const float delta = c[3] - b[3];
    float s = area > 0 ? (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + c[0] * q[0] + c[1] * q[1] +
                          c[2] * q[2] + of_x[0] * delta) /
                             area
                       : delta / 2;
    if (!std::isfinite(s)) s = delta / 2;
    value(v, k) = value(x, k) = std::clamp(b[3] + s, weighted_[k].low, weighted_[k].high);
  }
}

float QuadricChannels::given(std::uint32_t v, std::size_t channel, float weight) const noexcept {
  const Range& range = given_[channel];
  const float unweighted = value(v, channel) / weight;
  return unweighted >= range.low ? std::min(unweighted, range.high) : range.low;
}

}  // namespace merlin::render::reduce
