// Settings of a Spaceball.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"
#include "drivers/port/axes.h"

namespace merlin {

class SettingsVisitor;

inline constexpr int kSpaceballBaud = 9600;  // factory setting of its line

struct SpaceballSettings {
  // Raw counts of a full push, and of a full twist.
  int full_scale_translation = 8000;
  int full_scale_rotation = 1600;
  // An axis with at most this many raw counts is taken as at rest.
  int dead_zone = 16;
  // Settings inside the ball.
  int null_region = 20;  // weaker pushes and twists are reported as zero; 0 to 63, the ball's units
  bool cubic = true;     // whether the response is cubic (amplifies hard pushes) or linear
  bool rezero = true;    // whether the ball takes its state at open() as rest
  // Beep at open(): a lower-case letter is a tone, an upper-case one a pause; the nearer to a, the
  // shorter.
  std::string beep = {};
  // The device's axes for x, y, z and the rotations about them: 1..6 (X Y Z A B C), negative if the
  // axis is reversed.
  AxisMap axis_map = {1, 2, -3, 4, 5, -6};
};

// Returns a fault if an axis is missing or repeated in the axis map. Its JSON pointer is
// "/axis_map".
SettingFaults validate(const SpaceballSettings& ball);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(SpaceballSettings& ball, SettingsVisitor& visitor);

}  // namespace merlin
