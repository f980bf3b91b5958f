// Settings of a tracker whose poses arrive as OSC messages.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"
#include "drivers/port/tracker_placement.h"

namespace merlin {

class SettingsVisitor;

struct OscSettings {
  enum class Quaternion { kXyzw, kWxyz };

  // Address of the messages. kStation in it stands for the station's name; without it, the first
  // argument is the name; if that is no name, every message belongs to the first station.
  std::string address = "/tracker/{station}/pose";
  // Names that the sender gives to stations 1, 2 and so on; empty: the station is not used.
  std::vector<std::string> stations = {"1", "2", "3", "4"};
  Quaternion quaternion = Quaternion::kXyzw;  // order in which its components are sent
  double scale = 1;                           // metres in the sender's unit of length
  TrackerPlacement placement{};

  static constexpr const char* kStation = "{station}";
};

// Finds an address that is not valid in OSC, names of stations that are invalid, repeated or all
// empty, and a port of the wrong kind. Pointers, relative to the tracker: "/port", "/osc/address",
// "/osc/stations", "/osc/axes".
SettingFaults validate(const OscSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order of written files.
void describe(OscSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
