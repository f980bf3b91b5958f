// AxisSource: which axis of an input device moves one of a ball's six axes. Pure.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace merlin::evdev {

struct AxisSource {
  int code = -1;   // the kernel's number of the axis; -1: none
  int minus = -1;  // of the axis that pulls the other way, of a pair of triggers; -1: none
  bool reversed = false;

  bool operator==(const AxisSource&) const = default;
};

// For x, y, z and the rotations about them.
using AxisSources = std::array<AxisSource, 6>;

// Parses a form of kAxisForms; nothing if it is none.
std::optional<AxisSource> parseAxisSource(std::string_view text);

// The name in kAxisForms of an axis's number; empty if it has none.
std::string_view axisName(int code);

}  // namespace merlin::evdev
