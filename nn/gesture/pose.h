// Poses of the hand as a viewer at the wall sees them, and how the tracker's are turned into them.
// Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace merlin::nn {

// Coordinates of the wall: x right, y up, z from the wall to the person. The orientation is the
// unit quaternion q_wall_hand; the identity quaternion is a hand that points straight at the wall,
// along -z.
struct HandPose {
  std::int64_t at_ns = 0;  // any clock that does not jump
  std::array<float, 3> position_m{};
  std::array<float, 4> orientation_wxyz{1, 0, 0, 0};
};

// Turns poses of the tracker's frame into those of the wall. Immutable, hence thread-safe.
class WallAxes {
 public:
  // The tracker's axis that corresponds to each of the wall's axes x, y, z: 1 is x, 2 is y, 3 is z;
  // negative: the opposite direction. Nothing unless these are a right-handed system, in which each
  // of the tracker's axes occurs once.
  static std::optional<WallAxes> of(const std::array<int, 3>& tracker_axes) noexcept;
  // {-2, -3, 1}: the transmitter's x axis points from the wall to the person, y to the left, z
  // down.
  WallAxes() noexcept = default;

  // The result's `at_ns` is the argument. Allocation-free, a few ns.
  HandPose turned(std::int64_t at_ns, const float (&position_m)[3],
                  const float (&orientation_wxyz)[4]) const noexcept;

 private:
  std::array<int, 3> axes_{-2, -3, 1};
};

}  // namespace merlin::nn
