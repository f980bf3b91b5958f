// Poses of the hand in the wall's coordinates, and the conversion of the tracker's poses into them.
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

// Converts poses from the tracker's coordinates to the wall's. Immutable, hence thread-safe.
class WallAxes {
 public:
  // `tracker_axes`: the tracker's axis along each of the wall's axes x, y, z; 1 is x, 2 is y, 3 is
  // z, negative is the opposite direction. Returns nothing unless each of the tracker's axes occurs
  // once and the result is a right-handed system.
  static std::optional<WallAxes> of(const std::array<int, 3>& tracker_axes) noexcept;
  // Uses the axes {-2, -3, 1}: the tracker's transmitter has its x axis from the wall to the
  // person, y to the left and z down.
  WallAxes() noexcept = default;

  // Returns a pose of the tracker in the wall's coordinates, with the time `at_ns`.
  // Allocation-free, takes a few ns.
  HandPose turned(std::int64_t at_ns, const float (&position_m)[3],
                  const float (&orientation_wxyz)[4]) const noexcept;

 private:
  std::array<int, 3> axes_{-2, -3, 1};
};

}  // namespace merlin::nn
