#include "drivers/spaceball/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace merlin::spaceball {
namespace {

float share(int counts, int dead_zone, int full_scale) noexcept {
  const int beyond = std::max(std::abs(counts) - dead_zone, 0);
  const float magnitude =
      std::min(static_cast<float>(beyond) / static_cast<float>(full_scale - dead_zone), 1.0F);
  return counts < 0 ? -magnitude : magnitude;
}

}  // namespace

void calibrate(const Displacement& displacement, const SpaceballSettings& settings,
               BallSample& sample) noexcept {
  for (std::size_t i = 0; i < 6; ++i) {
    const int source = settings.axis_map[i];
    const int counts = displacement.axes[static_cast<std::size_t>(std::abs(source) - 1)];
    const int full = i < 3 ? settings.full_scale_translation : settings.full_scale_rotation;
    const float value = share(source < 0 ? -counts : counts, settings.dead_zone, full);
    (i < 3 ? sample.translation[i] : sample.rotation[i - 3]) = value;
    sample.raw[i] = displacement.axes[i];
  }
  sample.period_us = std::uint32_t{displacement.period} * 1000 / 16;
}

}  // namespace merlin::spaceball
