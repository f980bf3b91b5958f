#include "drivers/evdev/axis_source.h"

#include <linux/input-event-codes.h>

namespace merlin::evdev {
namespace {

struct NamedAxis {
  std::string_view name;
  int code;
};

constexpr NamedAxis kAxes[] = {{"x", ABS_X},
                               {"y", ABS_Y},
                               {"z", ABS_Z},
                               {"rx", ABS_RX},
                               {"ry", ABS_RY},
                               {"rz", ABS_RZ},
                               {"throttle", ABS_THROTTLE},
                               {"rudder", ABS_RUDDER},
                               {"wheel", ABS_WHEEL},
                               {"gas", ABS_GAS},
                               {"brake", ABS_BRAKE},
                               {"hat0x", ABS_HAT0X},
                               {"hat0y", ABS_HAT0Y},
                               {"hat1x", ABS_HAT1X},
                               {"hat1y", ABS_HAT1Y},
                               {"hat2x", ABS_HAT2X},
                               {"hat2y", ABS_HAT2Y},
                               {"hat3x", ABS_HAT3X},
                               {"hat3y", ABS_HAT3Y}};

std::optional<int> axisNumber(std::string_view name) {
  for (const NamedAxis& axis : kAxes) {
    if (axis.name == name) return axis.code;
  }
  return std::nullopt;
}

}  // namespace

std::optional<AxisSource> parseAxisSource(std::string_view text) {
  if (text == "none") return AxisSource{};
  AxisSource source;
  source.reversed = text.starts_with('-');
  if (source.reversed) text.remove_prefix(1);
  const auto between = text.find('-');
  const auto first = axisNumber(text.substr(0, between));
  if (!first) return std::nullopt;
  source.code = *first;
  if (between == std::string_view::npos) return source;
  const auto second = axisNumber(text.substr(between + 1));
  if (!second || source.reversed || *second == *first) return std::nullopt;
  source.minus = *second;
  return source;
}

std::string_view axisName(int code) {
  for (const NamedAxis& axis : kAxes) {
    if (axis.code == code) return axis.name;
  }
  return {};
}

}  // namespace merlin::evdev
