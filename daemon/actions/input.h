// Input: a button, posture or switch that a binding names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/shm/layout.h"

namespace merlin::actions {

struct Input {
  enum class Kind { kBallButton, kPosture, kWristSwitch, kPanelButton };

  Kind kind = Kind::kBallButton;
  std::uint32_t button = 0;  // kBallButton: its bit in BallSample::buttons
  std::string posture;       // kPosture: its name

  // The device to which the input belongs.
  shm::ActionSource source() const;
  bool operator==(const Input&) const = default;
};

// Parses the name of an input (kInputForms); nothing if the name is not valid.
std::optional<Input> parseInput(std::string_view name);

}  // namespace merlin::actions
