#include "drivers/evdev/settings.h"

#include <set>

#include <fmt/format.h>

#include "drivers/evdev/axis_source.h"

namespace merlin {
namespace {

constexpr std::size_t kAxes = 6, kButtons = 12;

}  // namespace

SettingFaults validate(const EvdevSettings& settings) {
  SettingFaults faults;
  if (!settings.axes.empty() && settings.axes.size() != kAxes) {
    faults.push_back(
        {"/axes", fmt::format("has {} texts; it needs {}, for x, y, z and the rotations "
                              "about them, or none",
                              settings.axes.size(), kAxes)});
  }
  for (std::size_t i = 0; i < settings.axes.size(); ++i) {
    if (evdev::parseAxisSource(settings.axes[i])) continue;
    faults.push_back({fmt::format("/axes/{}", i),
                      fmt::format("is \"{}\"; allowed are {}", settings.axes[i], kAxisForms)});
  }
  if (settings.buttons.size() > kButtons) {
    faults.push_back({"/buttons", fmt::format("has {} names; a ball has at most {} buttons",
                                              settings.buttons.size(), kButtons)});
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < settings.buttons.size(); ++i) {
    if (seen.insert(settings.buttons[i]).second) continue;
    faults.push_back(
        {fmt::format("/buttons/{}", i),
         fmt::format("is \"{}\" once more; each key can be one button", settings.buttons[i])});
  }
  return faults;
}

}  // namespace merlin
