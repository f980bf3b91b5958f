// Names of the kernel's axes, as the text of an AxisSource contains them. Pure.
#pragma once

#include <optional>
#include <string_view>

#include "drivers/port/axis_source.h"

namespace merlin::evdev {

// Returns the kernel's number of the axis that has this name in kAxisForms; nothing if none has it.
std::optional<int> axisNumber(std::string_view name);

// Returns the name in kAxisForms of the axis with this number; empty if it has none.
std::string_view axisName(int code);

}  // namespace merlin::evdev
