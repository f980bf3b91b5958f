// The description of the settings of a touch surface of a TUIO tracker.
#include "daemon/base/settings_visitor.h"
#include "drivers/tuio/settings.h"

namespace merlin {

void describe(TuioSettings& t, SettingsVisitor& v) {
  v.flag("swap_axes", t.orientation.swap_axes,
         "Whether the tracker's x axis runs along the height of the surface. Applied before "
         "invert_x and invert_y.");
  v.flag("invert_x", t.orientation.invert_x,
         "Whether the tracker reports a finger that moves to the right as moving to the left; "
         "merlind then reverses x.");
  v.flag("invert_y", t.orientation.invert_y,
         "Whether the tracker reports a finger that moves down as moving up; merlind then reverses "
         "y.");
  v.number("aspect", t.aspect, {0.1, 10},
           "Width of the surface divided by its height, as a person sees it. TUIO does not tell "
           "it.");
}

}  // namespace merlin
