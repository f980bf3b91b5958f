#include "config/describe_panel.h"

namespace merlin {

void describePanel(GpioSettings& g, SettingsVisitor& v) {
  v.text("chip", g.chip,
         "GPIO chip of the control panel: gpiochip0, /dev/gpiochip0, or its label as gpiodetect "
         "prints it. An adapter that is plugged in again may get another number, but keeps its "
         "label. Empty: there is no panel.");
  v.integer("projector_line", g.projector_line, {-1, 1023},
            "Number of the GPIO line that merlind sets high to power the projectors; -1: no such "
            "line.");
  v.integer("video_line", g.video_line, {-1, 1023},
            "Number of the GPIO line that controls the video switch, low for input A and high for "
            "input B; -1: no such line.");
  v.integer("lamp_line", g.lamp_line, {-1, 1023},
            "Number of the GPIO line that merlind sets high to light the status lamp; -1: no such "
            "line.");
  v.flag("lamp_warns", g.lamp_warns,
         "Whether the status lamp blinks fast, whatever it was switched to, while an output of the "
         "wall fails or shows something else than it was sent, or while the wall, after it has "
         "run, has been stopped for 15 seconds or longer.");
  v.integer("button_line", g.button_line, {-1, 1023},
            "Number of the GPIO line that is high while the panel's button is pressed; -1: no such "
            "line.");
  v.number(
      "warm_up_s", g.warm_up_s, {0, 3600},
      "Time that the projectors need after switching on before they show an image, in seconds.");
  v.number("cool_down_s", g.cool_down_s, {0, 3600},
           "Time after switching off during which the projectors are not switched on again, in "
           "seconds.");
  v.number("interlock_s", g.interlock_s, {0, 3600},
           "Minimum time between two switching operations of the projectors, in seconds.");
  v.number("debounce_s", g.debounce_s, {0, 1},
           "Minimum time that the button must be pressed before it takes effect, in seconds.");
}

}  // namespace merlin
