// The network's inputs: which joint each slot is, and how its angle becomes a number in [0, 1].
#pragma once

#include <array>

#include "nn/network.h"

namespace merlin::nn {

// Measurements of a glove in slot order: joint angles [rad], or its sensors' raw counts. A network
// is trained on one of the two and recalls the same.
enum class InputUnit { kRadians, kRaw };
using Angles = std::array<float, kInputs>;

// No joint's angle is beyond the first: a file that says so holds degrees or raw counts.
inline constexpr double kMostAngle_rad = 6.3, kMostRaw = 1e6;
constexpr double mostValue(InputUnit unit) {
  return unit == InputUnit::kRaw ? kMostRaw : kMostAngle_rad;
}

// In the network's unit.
struct InputRange {
  float low = 0.0F;   // becomes 0
  float high = 1.0F;  // becomes 1; above low
};
using InputRanges = std::array<InputRange, kInputs>;

extern const std::array<const char*, kInputs> kInputNames;  // "thumb-roll" ... "wrist-yaw"
extern const InputRanges kGloveRanges;                      // sources: nn/README.md, "Inputs"

// x_i = (value_i - low_i) / (high_i - low_i), held within [0, 1]: a joint bent past its range is as
// if at its end, so that what reaches the network is never far from what it was trained on. A NaN
// stays NaN. Allocation-free.
Input normalise(const InputRanges& ranges, const Angles& value) noexcept;

}  // namespace merlin::nn
