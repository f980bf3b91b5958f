// Settings of a tracker on a VRPN server.
#pragma once

#include <array>
#include <string>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"
#include "drivers/port/samples.h"
#include "drivers/port/tracker_placement.h"

namespace merlin {

class SettingsVisitor;

struct VrpnSettings {
  std::string device = "Tracker0";  // its name at the server, without "@HOST"
  // For each station, the server's number of its sensor; kNoSensor: the station is not used.
  std::array<int, kStations> stations = {0, 1, 2, 3};
  double scale = 1;  // metres in the server's unit of length; VRPN asks for metres
  TrackerPlacement placement{};

  static constexpr int kNoSensor = -1;
};

// Returns faults for an invalid name, stations that share a sensor, a list without any sensor,
// invalid axes, and, if the line has this driver, a port of the wrong kind. Their JSON pointers,
// relative to the tracker, are "/port", "/vrpn/device", "/vrpn/stations", "/vrpn/axes".
SettingFaults validate(const VrpnSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(VrpnSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
