#include "drivers/vrpn/settings.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr std::size_t kLongestName = 99;  // of VRPN

bool canBeServer(PortKind kind) {
  return kind == PortKind::kTcp || kind == PortKind::kPty || kind == PortKind::kReplay;
}

void checkName(const std::string& name, SettingFaults& faults) {
  const std::size_t at = name.find('@');
  if (at != std::string::npos) {
    faults.push_back({"/vrpn/device",
                      fmt::format("is \"{}\"; needed is the name alone, \"{}\": the host belongs "
                                  "into the port, tcp://HOST:3883",
                                  name, name.substr(0, at))});
  } else if (name.empty() || name.size() > kLongestName) {
    faults.push_back({"/vrpn/device", fmt::format("has {} characters; allowed are 1 to {}",
                                                  name.size(), kLongestName)});
  }
}

void checkStations(const VrpnSettings& settings, SettingFaults& faults) {
  auto used = settings.stations;
  const auto end = std::remove(used.begin(), used.end(), VrpnSettings::kNoSensor);
  std::sort(used.begin(), end);
  const bool repeated = std::adjacent_find(used.begin(), end) != end;
  if (end != used.begin() && !repeated) return;
  faults.push_back(
      {"/vrpn/stations",
       fmt::format("is {}; needed is a sensor for at least one station, and for each station "
                   "another one ({} for a station that is not used)",
                   fmt::join(settings.stations, ", "), VrpnSettings::kNoSensor)});
}

}  // namespace

SettingFaults validate(const VrpnSettings& settings, const LineSettings& line) {
  SettingFaults faults;
  const auto port = parsePort(line.port);
  if (line.driver == "vrpn" && port && !canBeServer(port->kind)) {
    faults.push_back({"/port", fmt::format("is \"{}\", at which no VRPN server can be; the driver "
                                           "\"vrpn\" needs tcp://HOST:PORT, usually port 3883",
                                           line.port)});
  }
  checkName(settings.device, faults);
  checkStations(settings, faults);
  return faults;
}

}  // namespace merlin
