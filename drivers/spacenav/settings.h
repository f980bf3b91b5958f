// Settings of a space mouse that spacenavd reads.
#pragma once

#include "daemon/base/setting_fault.h"
#include "drivers/port/axes.h"
#include "drivers/port/port_address.h"

namespace merlin {

class SettingsVisitor;

struct SpacenavSettings {
  int full_scale = 350;  // count of an axis at a full push or twist, as 3Dconnexion's mice send it
  int dead_zone = 10;    // up to this count an axis is taken as at rest
  // For x, y, z and the rotations about them: spacenavd's axis 1..6 (x y z rx ry rz), negative if
  // it is reversed.
  AxisMap axis_map = {1, 2, -3, 4, 5, -6};
};

// Finds an axis map in which an axis is missing or repeated, and a port of the wrong kind.
// Pointers: "/spacenav/axis_map", "/port".
SettingFaults validate(const SpacenavSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order of written files.
void describe(SpacenavSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
