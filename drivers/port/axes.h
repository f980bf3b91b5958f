// The axes of a ball: converts raw values to shares of full scale, and maps a device's axes to
// MERLIN's. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/base/setting_fault.h"
#include "drivers/port/samples.h"

namespace merlin {

// Returns a share of full scale, -1..1. Values up to `dead_zone` give 0, and beyond it the scale
// starts at 0, so that the result is continuous at its edge. `dead_zone` and `full_scale` are in
// the unit of `value`. REQUIRES: dead_zone < full_scale.
inline float axisShare(float value, float dead_zone, float full_scale) noexcept {
  const float beyond = std::max(std::abs(value) - dead_zone, 0.0F);
  const float share = std::min(beyond / (full_scale - dead_zone), 1.0F);
  return value < 0 ? -share : share;
}

// Writes the axes of an input device into `sample`. `deflections`: along x, y, z and about these
// axes, -1..1. Deflections up to `dead_zone` give 0, the rest of the scale is raised to the power
// `curve`. The raw values are the deflections in thousandths, before dead zone and curve, in a
// Spaceball's axes, whose z points away from the person, because clients of the space-mouse socket
// expect these axes.
void fillAxes(const std::array<float, 6>& deflections, float dead_zone, float curve,
              BallSample& sample) noexcept;

// The device's axes for x, y, z and the rotations about them: 1..6, negative if the axis is
// reversed.
using AxisMap = std::array<int, 6>;

// Returns a fault if an axis is missing or repeated in the map. Its JSON pointer is "/axis_map".
SettingFaults validateAxisMap(const AxisMap& map);

}  // namespace merlin
