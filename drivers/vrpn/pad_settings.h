// Settings of buttons and analog channels of a VRPN server that serve as a ball.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"

namespace merlin {

class SettingsVisitor;

struct VrpnPadSettings {
  std::string device = "Joystick0";  // its name at the server, without "@HOST"
  // The channels that control x, y, z and the rotations about them, as six texts in the forms of
  // kChannelForms. If empty, they are the channels 0 to 5.
  std::vector<std::string> axes;
  // The server's numbers of the buttons that bindings call NAME.button.1, NAME.button.2 and so on.
  // If empty, they are 0 to 11.
  std::vector<std::string> buttons;
  double rest = 0, full = 1;  // values of a channel at rest and at full deflection to the right
  double dead_zone = 0.08;    // up to this share of full deflection an axis counts as at rest
  double curve = 2;           // exponent of the response: 1 is linear, more is finer near rest
};

inline constexpr const char* kChannelForms =
    "the server's number of a channel, 0 to 127, for example 3; such a number after a minus sign, "
    "if the channel is reversed: -3; two numbers joined by a minus sign, for a pair of triggers, "
    "the second of which acts in the opposite direction: 5-2; and the word none, for no channel";

// Returns faults for an invalid name, invalid axes and buttons, equal values of `rest` and `full`,
// and a port of the wrong kind. Their JSON pointers, relative to the device, are "/port",
// "/vrpn_pad/device", "/vrpn_pad/axes/INDEX" ...
SettingFaults validate(const VrpnPadSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(VrpnPadSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
