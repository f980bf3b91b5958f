// AxisSource: which axis of an input device moves one of a ball's six axes, and its text in the
// configuration. Pure.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct AxisSource {
  int axis = -1;   // the device's number of the axis; -1: none
  int minus = -1;  // of the axis that pulls the other way, of a pair of triggers; -1: none
  bool reversed = false;

  bool operator==(const AxisSource&) const = default;
};

// Where an axis of an input device stands.
struct AxisReading {
  std::string name;      // as in an AxisSource's text
  float deflection = 0;  // -1..1, from one end to the other
};

// For x, y, z and the rotations about them.
using AxisSources = std::array<AxisSource, 6>;

// The number of an axis with this name; nothing if there is none.
using AxisNumber = std::function<std::optional<int>(std::string_view name)>;

// Parses NAME, -NAME (reversed), NAME-NAME (the second pulls the other way) and "none"; nothing if
// the text is none of these.
std::optional<AxisSource> parseAxisSource(std::string_view text, const AxisNumber& number);

// Adds a fault for another number of texts than six, unless there are none, for each text that
// cannot be parsed, and for each that names an axis which one before it names. `pointer`: of the
// list; `forms`: what is allowed, for a person.
void checkAxisSources(const std::vector<std::string>& texts, const AxisNumber& number,
                      const std::string& pointer, const char* forms, SettingFaults& faults);

}  // namespace merlin
