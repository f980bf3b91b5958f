// The description of the settings of a space mouse that spacenavd reads.
#include "daemon/base/settings_visitor.h"
#include "drivers/spacenav/settings.h"

namespace merlin {

void describe(SpacenavSettings& s, SettingsVisitor& v) {
  v.integer("full_scale", s.full_scale, {100, 32767},
            "Count of an axis at a full push or twist, as spacenavd sends it.");
  v.integer("dead_zone", s.dead_zone, {0, 99},
            "Largest count of an axis, positive or negative, that is treated as rest.");
  v.numbers("axis_map", s.axis_map, {-6, 6},
            "Axis of spacenavd for each of x, y, z and the rotations about x, y, z: 1 to 3 are its "
            "x, y, z, and 4 to 6 its rotations; a negative number reverses the axis.");
}

}  // namespace merlin
