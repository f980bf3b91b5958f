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
  std::string device;  // whose input it is; empty: that of every device that has such a one
  // kButton: its bit in BallSample::buttons; of an axis that is pushed: a bit of pushedAxes().
  std::uint32_t button = 0;
  std::string posture;  // kPosture: its name

  bool isOf(const Source& source) const;
  // Whether one event can be both: the same part of the same device.
  bool overlaps(const Input& other) const;
  bool operator==(const Input&) const = default;
};

// The axes of a ball that are pushed or twisted by more than half, as bits above those of the
// buttons: x+ x- y+ y- z+ z- rx+ ... rz-. An axis that was among `before` stays until it falls
// below a third, so that one that trembles there begins nothing twice.
std::uint32_t pushedAxes(const BallSample& ball, std::uint32_t before) noexcept;

// Parses the name of an input (kInputForms); nothing if the name is not valid.
std::optional<Input> parseInput(std::string_view name);

}  // namespace merlin::actions
