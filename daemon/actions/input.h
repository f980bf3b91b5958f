// Input: a button, posture or switch that a binding names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/port/samples.h"

namespace merlin::actions {

// Whose inputs trigger actions: a device, or the control panel.
struct Source {
  std::string name;                // of the device
  std::optional<SampleKind> kind;  // of the device; none: the panel
};

struct Input {
  enum class Kind { kButton, kPosture, kWristSwitch, kPanelButton };

  Kind kind = Kind::kButton;
  std::string device;        // whose input it is; empty: that of every device that has such a one
  std::uint32_t button = 0;  // kButton: its bit in BallSample::buttons
  std::string posture;       // kPosture: its name

  bool isOf(const Source& source) const;
  // Whether one event can be both: the same part of the same device.
  bool overlaps(const Input& other) const;
  bool operator==(const Input&) const = default;
};

// Parses the name of an input (kInputForms); nothing if the name is not valid.
std::optional<Input> parseInput(std::string_view name);

}  // namespace merlin::actions
