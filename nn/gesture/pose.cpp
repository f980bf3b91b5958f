#include "nn/gesture/pose.h"

#include <cstddef>
#include <cstdlib>

namespace merlin::nn {

std::optional<WallAxes> WallAxes::of(const std::array<int, 3>& tracker_axes) noexcept {
  int sign = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = std::abs(tracker_axes[i]);
    if (axis < 1 || axis > 3) return std::nullopt;
    if (tracker_axes[i] < 0) sign = -sign;
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(tracker_axes[j]) == axis) return std::nullopt;
      if (std::abs(tracker_axes[j]) > axis) sign = -sign;
    }
  }
  if (sign < 0) return std::nullopt;
  WallAxes axes;
  axes.axes_ = tracker_axes;
  return axes;
}

HandPose WallAxes::turned(std::int64_t at_ns, const float (&position_m)[3],
                          const float (&orientation_wxyz)[4]) const noexcept {
  HandPose pose;
  pose.at_ns = at_ns;
  pose.orientation_wxyz[0] = orientation_wxyz[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(std::abs(axes_[i]) - 1);
    const float sign = axes_[i] < 0 ? -1.0F : 1.0F;
    pose.position_m[i] = sign * position_m[axis];
    // The rotation axis is transformed like a vector.
    pose.orientation_wxyz[i + 1] = sign * orientation_wxyz[axis + 1];
  }
  return pose;
}

}  // namespace merlin::nn
