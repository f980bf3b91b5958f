// The description of a Spaceball's settings.
#include "daemon/base/settings_visitor.h"
#include "drivers/spaceball/settings.h"

namespace merlin {

void describe(SpaceballSettings& ball, SettingsVisitor& v) {
  v.integer("full_scale_translation", ball.full_scale_translation, {100, 32767},
            "Raw count of a translation axis at a full push of the ball.");
  v.integer("full_scale_rotation", ball.full_scale_rotation, {100, 32767},
            "Raw count of a rotation axis at a full twist of the ball.");
  v.integer("null_region", ball.null_region, {0, 63},
            "Size of the null region inside the ball, in the ball's own units: it reports weaker "
            "pushes and twists as zero.");
  v.flag("cubic", ball.cubic,
         "Whether the response of the ball itself is cubic instead of linear, which amplifies hard "
         "pushes more than gentle ones.");
  v.flag("rezero", ball.rezero,
         "Whether the ball takes its present state as its rest position when merlind opens it. "
         "Nobody may touch the ball at that moment.");
  v.text("beep", ball.beep,
         "Tune that the ball beeps when it is ready: a lower-case letter is a tone, an upper-case "
         "letter a pause; letters nearer to a are shorter. Empty: no tune.");
  v.integer("dead_zone", ball.dead_zone, {0, 99},
            "Largest raw count of an axis, positive or negative, that is treated as rest.");
  v.numbers("axis_map", ball.axis_map, {-6, 6},
            "Device axis for each of x, y, z and the rotations about x, y, z: 1 to 3 are the "
            "device's X, Y, Z, and 4 to 6 its rotations A, B, C; a negative number reverses the "
            "axis.");
}

}  // namespace merlin
