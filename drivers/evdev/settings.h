// Settings of an input device of the kernel that serves as the ball.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"

namespace merlin {

class SettingsVisitor;

struct EvdevSettings {
  // The device's axes that control x, y, z and the rotations about them, as six texts in the forms
  // of kAxisForms. If empty, they are chosen by the kind of device (drivers/evdev/README.md).
  std::vector<std::string> axes;
  // The device's keys that bindings call NAME.button.1, NAME.button.2 and so on, by the kernel's
  // names without KEY_ or BTN_. If empty, they are the first twelve buttons of the device, in the
  // order of the kernel's numbers.
  std::vector<std::string> buttons;
  double dead_zone = 0.08;  // up to this share of full deflection an axis counts as at rest
  double curve = 2;         // exponent of the response: 1 is linear, more is finer near rest
};

inline constexpr const char* kAxisForms =
    "the kernel's name of an axis, in lower case and without ABS_ (x, y, z, rx, ry, rz, throttle, "
    "rudder, wheel, gas, brake, hat0x ... hat3y), for example rx; such a name after a minus sign, "
    "if the axis is reversed: -rx; two names joined by a minus sign, for a pair of triggers, the "
    "second of which acts in the opposite direction: rz-z; and the word none, for no axis";

// Returns faults for invalid axes and buttons, and for a port that cannot be an input device. Their
// JSON pointers are "/evdev/axes", "/evdev/axes/INDEX", "/evdev/buttons", "/evdev/buttons/INDEX",
// "/port".
SettingFaults validate(const EvdevSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(EvdevSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
