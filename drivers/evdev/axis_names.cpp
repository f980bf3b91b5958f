#include "drivers/evdev/axis_names.h"

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

}  // namespace

std::optional<int> axisNumber(std::string_view name) {
  for (const NamedAxis& axis : kAxes) {
    if (axis.name == name) return axis.code;
  }
  return std::nullopt;
}

std::string_view axisName(int code) {
  for (const NamedAxis& axis : kAxes) {
    if (axis.code == code) return axis.name;
  }
  return {};
}

}  // namespace merlin::evdev
