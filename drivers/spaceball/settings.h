// Settings of a Spaceball.
#pragma once

#include <array>
#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct SpaceballSettings {
  // Counts that stand for a full push, and for a full twist [raw counts].
  int full_scale_translation = 8000;
  int full_scale_rotation = 1600;
  // Counts of each axis that are taken for rest [raw counts].
  int dead_zone = 16;
  // The ball's own: how much push counts as none (0 to 63), whether a harder push counts for more
  // than in proportion, whether its rest is taken anew when it is opened, and what it beeps then
  // (letters, lower case a tone, upper a pause, nearer to a shorter).
  int null_region = 20;
  bool cubic = true;
  bool rezero = true;
  std::string beep = {};
  // For x, y, z and the rotations about them: the device's axis 1..6 (X Y Z A B C), negative to
  // turn it round.
  std::array<int, 6> axis_map = {1, 2, -3, 4, 5, -6};
};

// Finds an axis map that does not have each axis once. Pointer: "/axis_map".
SettingFaults validate(const SpaceballSettings& ball);

}  // namespace merlin
