// What the configuration says of a Spaceball.
#pragma once

#include <array>

namespace merlin {

struct SpaceballSettings {
  // Counts that stand for a full push, and for a full twist [raw counts].
  int full_scale_translation = 8000;
  int full_scale_rotation = 1600;
  // Counts of each axis that are taken for rest [raw counts].
  int dead_zone = 16;
  // For x, y, z and the rotations about them: the device's axis 1..6 (X Y Z A B C), negative to
  // turn it round.
  std::array<int, 6> axis_map = {1, 2, -3, 4, 5, -6};
};

}  // namespace merlin
