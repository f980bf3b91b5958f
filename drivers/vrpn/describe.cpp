// The descriptions of the settings of devices on a VRPN server.
#include <fmt/format.h>

#include "daemon/base/settings_visitor.h"
#include "drivers/vrpn/pad_settings.h"
#include "drivers/vrpn/settings.h"

namespace merlin {

void describe(VrpnSettings& s, SettingsVisitor& v) {
  v.text("device", s.device,
         "Name of the tracker at the server, without @HOST, such as Tracker0. If it is wrong, the "
         "tracker's state names the devices that the server has.");
  v.numbers(
      "stations", s.stations, {VrpnSettings::kNoSensor, 9999},
      "The server's number of the sensor that is station 1, 2, 3 and 4; -1 for a station that "
      "is not used.");
  v.number("scale", s.scale, {1e-6, 1e3},
           "Metres in the server's unit of length: 1 for metres, which VRPN asks for, 0.001 for a "
           "server that sends millimetres.");
  describe(s.placement, v);
}

void describe(VrpnPadSettings& s, SettingsVisitor& v) {
  static const std::string kAxes = fmt::format(
      "Channel of the analog for each of x, y, z and the rotations about x, y, z, as six texts: "
      "{}. "
      "Empty: the channels 0 to 5 in this order.",
      kChannelForms);
  v.text("device", s.device,
         "Name of the button box, joystick or analog at the server, without @HOST, such as "
         "Joystick0. If it is wrong, the state of the device names those that the server has.");
  v.texts("axes", s.axes, kAxes.c_str());
  v.texts("buttons", s.buttons,
          "Buttons of the server that count as the buttons 1, 2 and so on of this device, which "
          "bindings call NAME.button.1, NAME.button.2 and so on. They are given by the server's "
          "numbers, as texts; the server's first button is \"0\". Empty: the buttons 0 to 11.");
  v.number("rest", s.rest, {-1e6, 1e6}, "Value of a channel at rest, in the server's unit.");
  v.number("full", s.full, {-1e6, 1e6},
           "Value of a channel at full deflection in its positive direction, in the server's unit. "
           "In the negative direction the value at full deflection is equally far from `rest`.");
  v.number("dead_zone", s.dead_zone, {0, 0.9},
           "Share of an axis's full deflection, to either side, that is treated as rest.");
  v.number("curve", s.curve, {1, 5},
           "Exponent of the response to an axis's deflection. 1: linear; greater values make small "
           "deflections finer.");
}

}  // namespace merlin
