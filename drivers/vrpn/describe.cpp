// The description of the settings of a tracker of a VRPN server.
#include "daemon/base/settings_visitor.h"
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
}

}  // namespace merlin
