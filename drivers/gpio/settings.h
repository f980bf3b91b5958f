// Settings of the control panel: the purpose of each line, and times.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct GpioSettings {
  std::string chip;  // "gpiochip0", "/dev/gpiochip0" or a label; empty: there is no panel
  // Numbers of the chip's lines; -1: no line has this purpose.
  int projector_line = -1;  // high: the projectors are on
  int video_line = -1;      // low: A, high: B
  int lamp_line = -1;       // high: lit
  bool lamp_warns = true;   // the lamp blinks fast while the wall needs attention
  int button_line = -1;     // high while pressed
  double warm_up_s = 30;    // time from switching projectors on until they show an image
  double cool_down_s = 90;  // time after switching off for which they must not be switched on
  double interlock_s = 5;   // minimum time between any two switchings
  double debounce_s = 0.02;
};

// Returns a fault for each line that has two purposes. Its JSON pointer is "".
SettingFaults validate(const GpioSettings& gpio);

}  // namespace merlin
