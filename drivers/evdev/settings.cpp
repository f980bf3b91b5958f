#include "drivers/evdev/settings.h"

#include <set>

#include <fmt/format.h>

#include "drivers/evdev/axis_names.h"

namespace merlin {
namespace {

constexpr std::size_t kButtons = 12;

void checkPort(const LineSettings& line, SettingFaults& faults) {
  const auto port = parsePort(line.port);
  const bool fits = !port || port->kind == PortKind::kEvdev || port->kind == PortKind::kPty ||
                    port->kind == PortKind::kReplay;
  if (line.driver != "evdev" || fits) return;
  faults.push_back({"/port", fmt::format("is \"{}\", which is not an input device; the driver "
                                         "\"evdev\" needs evdev:/dev/input/..., which `merlin "
                                         "devices` prints",
                                         line.port)});
}

void checkButtons(const EvdevSettings& settings, SettingFaults& faults) {
  if (settings.buttons.size() > kButtons) {
    faults.push_back({"/evdev/buttons", fmt::format("has {} names; a ball has at most {} buttons",
                                                    settings.buttons.size(), kButtons)});
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < settings.buttons.size(); ++i) {
    if (seen.insert(settings.buttons[i]).second) continue;
    faults.push_back(
        {fmt::format("/evdev/buttons/{}", i),
         fmt::format("is \"{}\", which is listed before; each key can be only one button",
                     settings.buttons[i])});
  }
}

}  // namespace

SettingFaults validate(const EvdevSettings& settings, const LineSettings& line) {
  SettingFaults faults;
  checkPort(line, faults);
  checkAxisSources(settings.axes, evdev::axisNumber, "/evdev/axes", kAxisForms, faults);
  checkButtons(settings, faults);
  return faults;
}

}  // namespace merlin
