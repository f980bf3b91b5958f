#include "drivers/osc/settings.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "drivers/port/samples.h"

namespace merlin {
namespace {

constexpr std::size_t kLongestAddress = 200, kLongestName = 40;
// Characters that OSC reserves for patterns, and the space; "{station}" is replaced before the
// check.
constexpr std::string_view kNotInAddress = " #*,?[]{}";

bool hasOnlyPrintable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F; });
}

bool isAddress(std::string text) {
  const std::string_view station = OscSettings::kStation;
  if (const std::size_t at = text.find(station); at != std::string::npos)
    text.replace(at, station.size(), "1");
  return text.size() > 1 && text.size() <= kLongestAddress && text[0] == '/' &&
         hasOnlyPrintable(text) && text.find_first_of(kNotInAddress) == std::string::npos;
}

bool isName(std::string_view text) {
  return text.size() <= kLongestName && hasOnlyPrintable(text) &&
         text.find_first_of(kNotInAddress) == std::string::npos &&
         text.find('/') == std::string::npos;
}

void checkStations(const OscSettings& settings, SettingFaults& faults) {
  std::set<std::string> names;
  bool good = settings.stations.size() <= kStations;
  for (const std::string& name : settings.stations)
    good = good && isName(name) && (name.empty() || names.insert(name).second);
  if (good && !names.empty()) return;
  faults.push_back(
      {"/osc/stations",
       fmt::format("is \"{}\"; needed are 1 to {} names of at most {} characters, without spaces, "
                   "/ and any of #*,?[]{{}}, each only once (\"\" for a station that is not used)",
                   fmt::join(settings.stations, "\", \""), kStations, kLongestName)});
}

}  // namespace

SettingFaults validate(const OscSettings& settings, const LineSettings& line) {
  SettingFaults faults;
  const auto port = parsePort(line.port);
  const bool fits = !port || port->kind == PortKind::kUdp || port->kind == PortKind::kPty ||
                    port->kind == PortKind::kReplay;
  if (line.driver == "osc" && !fits) {
    faults.push_back({"/port", fmt::format("is \"{}\", at which no OSC arrives; the driver \"osc\" "
                                           "needs udp:PORT or udp://ADDRESS:PORT",
                                           line.port)});
  }
  if (!isAddress(settings.address)) {
    faults.push_back(
        {"/osc/address", fmt::format("is \"{}\"; needed is / and a text without spaces and without "
                                     "any of #*,?[], such as /tracker/{{station}}/pose",
                                     settings.address)});
  }
  checkStations(settings, faults);
  checkPlacement(settings.placement, "/osc", faults);
  return faults;
}

}  // namespace merlin
