// The description of the settings of a touch frame, touch screen or mouse.
#include "daemon/base/settings_visitor.h"
#include "drivers/touch/settings.h"

namespace merlin {

void describe(TouchSettings& t, SettingsVisitor& v) {
  v.flag("swap_axes", t.orientation.swap_axes,
         "Whether the device's x axis runs along the height of the surface: for a frame that is "
         "mounted upright. Applied before invert_x and invert_y.");
  v.flag("invert_x", t.orientation.invert_x,
         "Whether the device reports a finger that moves to the right as moving to the left; "
         "merlind then reverses x.");
  v.flag(
      "invert_y", t.orientation.invert_y,
      "Whether the device reports a finger that moves down as moving up; merlind then reverses y.");
  v.number("aspect", t.aspect, {0, 10},
           "Width of the surface divided by its height, as a person sees it. 0: computed from the "
           "resolutions of the device's axes or, if it does not tell them, from the ranges of its "
           "axes. If those ranges are equal, and for a mouse, 0 means 16:9.");
  v.integer(
      "mouse_counts", t.mouse_counts, {10, 100'000},
      "Number of counts that a mouse must move to drag over the whole height of the surface.");
}

}  // namespace merlin
