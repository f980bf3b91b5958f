#include "drivers/vrpn/pad_settings.h"

#include <set>

#include <fmt/format.h>

#include "drivers/port/axis_source.h"
#include "drivers/port/vrpn_line.h"
#include "drivers/vrpn/numbers.h"
#include "drivers/vrpn/server_checks.h"

namespace merlin {
namespace {

constexpr std::size_t kButtons = 12;

void checkButtons(const VrpnPadSettings& settings, SettingFaults& faults) {
  if (settings.buttons.size() > kButtons) {
    faults.push_back(
        {"/vrpn_pad/buttons", fmt::format("has {} numbers; a ball has at most {} buttons",
                                          settings.buttons.size(), kButtons)});
  }
  std::set<int> seen;
  for (std::size_t i = 0; i < settings.buttons.size(); ++i) {
    const auto number = vrpn::parseNumber(settings.buttons[i], kVrpnButtons);
    if (number && seen.insert(*number).second) continue;
    faults.push_back(
        {fmt::format("/vrpn_pad/buttons/{}", i),
         number ? fmt::format("is \"{}\", which is listed before; each button of the server can be "
                              "only one button",
                              settings.buttons[i])
                : fmt::format("is \"{}\"; allowed are the server's numbers of buttons, 0 to {}",
                              settings.buttons[i], kVrpnButtons - 1)});
  }
}

}  // namespace

SettingFaults validate(const VrpnPadSettings& settings, const LineSettings& line) {
  SettingFaults faults;
  vrpn::checkPort(line, "vrpn_pad", faults);
  vrpn::checkName(settings.device, "/vrpn_pad/device", faults);
  checkAxisSources(settings.axes, vrpn::channelNumber, "/vrpn_pad/axes", kChannelForms, faults);
  checkButtons(settings, faults);
  if (settings.rest == settings.full) {
    faults.push_back(
        {"/vrpn_pad/full", fmt::format("is {}, as \"rest\" is; needed is a channel's value at full "
                                       "deflection, which differs from that at rest",
                                       settings.full)});
  }
  return faults;
}

}  // namespace merlin
