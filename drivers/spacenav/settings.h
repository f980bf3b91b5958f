// Settings of a space mouse that spacenavd reads.
#pragma once

#include "daemon/base/setting_fault.h"
#include "drivers/port/axes.h"
#include "drivers/port/port_address.h"

namespace merlin {

class SettingsVisitor;

struct SpacenavSettings {
  int full_scale = 350;  // count of an axis at full deflection, as 3Dconnexion's mice send it
  int dead_zone = 10;    // an axis counts as at rest up to this count
  // spacenavd's axes for x, y, z and the rotations about them: 1..6 (x y z rx ry rz), negative if
  // the axis is reversed.
  AxisMap axis_map = {1, 2, -3, 4, 5, -6};
};

// Returns faults for an axis map in which an axis is missing or repeated, and for a port of the
// wrong kind. Their JSON pointers are "/spacenav/axis_map" and "/port".
SettingFaults validate(const SpacenavSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(SpacenavSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
