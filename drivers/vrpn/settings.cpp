#include "drivers/vrpn/settings.h"

#include <algorithm>

#include <fmt/format.h>

#include "drivers/vrpn/server_checks.h"

namespace merlin {
namespace {

void checkStations(const VrpnSettings& settings, SettingFaults& faults) {
  auto used = settings.stations;
  const auto end = std::remove(used.begin(), used.end(), VrpnSettings::kNoSensor);
  std::sort(used.begin(), end);
  const bool repeated = std::adjacent_find(used.begin(), end) != end;
  if (end != used.begin() && !repeated) return;
  faults.push_back(
      {"/vrpn/stations",
       fmt::format("is {}; needed is a sensor for at least one station, and no sensor for "
                   "two stations ({} for a station that is not used)",
                   fmt::join(settings.stations, ", "), VrpnSettings::kNoSensor)});
}

}  // namespace

SettingFaults validate(const VrpnSettings& settings, const LineSettings& line) {
  SettingFaults faults;
  vrpn::checkPort(line, "vrpn", faults);
  vrpn::checkName(settings.device, "/vrpn/device", faults);
  checkStations(settings, faults);
  checkPlacement(settings.placement, "/vrpn", faults);
  return faults;
}

}  // namespace merlin
