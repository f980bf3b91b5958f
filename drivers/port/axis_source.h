// AxisSource: the axis of an input device that controls one of a ball's six axes, and its text in
// the configuration. Pure.
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
  int minus = -1;  // axis of the opposite direction, in a pair of triggers; -1: none
  bool reversed = false;

  bool operator==(const AxisSource&) const = default;
};

// Present deflection of an axis of an input device.
struct AxisReading {
  std::string name;      // as in an AxisSource's text
  float deflection = 0;  // -1..1, from one end to the other
};

// Sources for x, y, z and the rotations about them.
using AxisSources = std::array<AxisSource, 6>;

// Looks up the device's number of the axis with this name; returns nothing if there is none.
using AxisNumber = std::function<std::optional<int>(std::string_view name)>;

// Parses NAME, -NAME (reversed), NAME-NAME (the second acts in the opposite direction) and "none";
// nothing if the text is none of these.
std::optional<AxisSource> parseAxisSource(std::string_view text, const AxisNumber& number);

// Adds a fault if the number of texts is neither six nor zero, for each text that cannot be parsed,
// and for each text that names an axis again. `pointer`: JSON pointer of the list; `forms`: the
// allowed forms, for a person.
void checkAxisSources(const std::vector<std::string>& texts, const AxisNumber& number,
                      const std::string& pointer, const char* forms, SettingFaults& faults);

}  // namespace merlin
