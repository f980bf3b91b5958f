#include "drivers/spaceball/calibration.h"

#include <cstdlib>

#include "drivers/port/axes.h"

namespace merlin::spaceball {

void calibrate(const Displacement& displacement, const SpaceballSettings& settings,
               BallSample& sample) noexcept {
  for (std::size_t i = 0; i < 6; ++i) {
    const int source = settings.axis_map[i];
    const int counts = displacement.axes[static_cast<std::size_t>(std::abs(source) - 1)];
    const int full = i < 3 ? settings.full_scale_translation : settings.full_scale_rotation;
    const float value = axisShare(static_cast<float>(source < 0 ? -counts : counts),
                                  static_cast<float>(settings.dead_zone), static_cast<float>(full));
    (i < 3 ? sample.translation[i] : sample.rotation[i - 3]) = value;
    sample.raw[i] = displacement.axes[i];
  }
  sample.period_us = std::uint32_t{displacement.period} * 1000 / 16;
}

}  // namespace merlin::spaceball
