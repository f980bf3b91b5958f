// The network's inputs: which joint each slot is, and how its angle becomes a number in [0, 1].
#pragma once

#include <array>

#include "nn/network.h"

namespace merlin::nn {

using Angles = std::array<float, kInputs>;  // joint angles in slot order [rad]

// No joint's angle is beyond: a file that says so holds degrees or raw counts.
inline constexpr double kMostAngle_rad = 6.3;

struct InputRange {
  float low_rad = 0.0F;   // becomes 0
  float high_rad = 1.0F;  // becomes 1; above low_rad
};
using InputRanges = std::array<InputRange, kInputs>;

extern const std::array<const char*, kInputs> kInputNames;  // "thumb-roll" ... "wrist-yaw"
extern const InputRanges kGloveRanges;                      // sources: nn/README.md, "Inputs"

// x_i = (angle_i - low_i) / (high_i - low_i), held within [0, 1]: a joint bent past its range is as
// if at its end, so that what reaches the network is never far from what it was trained on. A NaN
// stays NaN. Allocation-free.
Input normalise(const InputRanges& ranges, const Angles& angle_rad) noexcept;

}  // namespace merlin::nn
