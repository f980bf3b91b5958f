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

  // Address of the messages with poses. In it, kStation stands for the station's name. An address
  // without kStation is that of all stations: the first argument of a message is then the station's
  // name, or, if the message has no name, it belongs to the first used station.
  std::string address = "/tracker/{station}/pose";
  // Names that the sender gives to stations 1, 2 and so on; empty: the station is not used.
  std::vector<std::string> stations = {"1", "2", "3", "4"};
  Quaternion quaternion = Quaternion::kXyzw;  // order in which its components are sent
  double scale = 1;                           // metres in the sender's unit of length
  TrackerPlacement placement{};

  static constexpr const char* kStation = "{station}";
};

// Returns faults for an address that is not valid in OSC, names of stations that are invalid,
// repeated or all empty, invalid axes, and a port of the wrong kind. Their JSON pointers, relative
// to the tracker, are "/port", "/osc/address", "/osc/stations", "/osc/axes".
SettingFaults validate(const OscSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(OscSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
