// The names of the kernel's axes, as an AxisSource has them. Pure.
#pragma once

#include <optional>
#include <string_view>

#include "drivers/port/axis_source.h"

namespace merlin::evdev {

// The kernel's number of the axis with this name of kAxisForms; nothing if there is none.
std::optional<int> axisNumber(std::string_view name);

// The name in kAxisForms of an axis's number; empty if it has none.
std::string_view axisName(int code);

}  // namespace merlin::evdev
