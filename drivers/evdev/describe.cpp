// The description of the settings of an input device that serves as the ball.
#include <fmt/format.h>

#include "daemon/base/settings_visitor.h"
#include "drivers/evdev/settings.h"

namespace merlin {

void describe(EvdevSettings& e, SettingsVisitor& v) {
  static const std::string kAxes = fmt::format(
      "Axis of the input device for each of x, y, z and the rotations about x, y, z, as six texts: "
      "{}. Empty: the axes that suit the kind of device.",
      kAxisForms);
  v.texts("axes", e.axes, kAxes.c_str());
  v.texts("buttons", e.buttons,
          "Keys of the input device that count as its buttons 1, 2 and so on, which bindings call "
          "NAME.button.1, NAME.button.2 and so on. They are given by the kernel's names without "
          "KEY_ or BTN_, in lower case, such as south, tl or pagedown. Empty: the first twelve "
          "buttons of the device. Bindings that name a key, NAME.key.pagedown, or a button, "
          "NAME.button.south, need no entry here.");
  v.number("dead_zone", e.dead_zone, {0, 0.9},
           "Share of an axis's full deflection, to either side, that is treated as rest.");
  v.number("curve", e.curve, {1, 5},
           "Exponent of the response to an axis's deflection. 1: linear; greater values make small "
           "deflections finer.");
}

}  // namespace merlin
