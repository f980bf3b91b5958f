// The network's inputs: the joint of each slot, and how its angle is scaled to [0, 1].
#pragma once

#include <array>

#include "nn/network.h"

namespace merlin::nn {

// Unit of a glove's measurements: joint angles [rad], or raw counts of its sensors. A network takes
// measurements in the unit in which it was trained.
enum class InputUnit { kRadians, kRaw };
// A glove's measurements in the order of the slots, in either unit.
using Angles = std::array<float, kInputs>;

// Greatest absolute values of an input. No joint's angle exceeds kMostAngle_rad; a file with larger
// values contains degrees or raw counts.
inline constexpr double kMostAngle_rad = 6.3, kMostRaw = 1e6;
constexpr double mostValue(InputUnit unit) {
  return unit == InputUnit::kRaw ? kMostRaw : kMostAngle_rad;
}

// The range of a slot in the network's unit.
struct InputRange {
  float low = 0.0F;   // scaled to 0
  float high = 1.0F;  // scaled to 1; above low
};
using InputRanges = std::array<InputRange, kInputs>;

// Names of the slots, "thumb-roll" ... "wrist-yaw".
extern const std::array<const char*, kInputs> kInputNames;
extern const InputRanges kGloveRanges;  // [rad]; sources: nn/README.md, "Slots"

// Returns x_i = (value_i - low_i) / (high_i - low_i), clamped to [0, 1], so that the inputs are
// never far from those of training, even if a joint is bent beyond its range. A NaN stays NaN.
// Allocation-free.
Input normalise(const InputRanges& ranges, const Angles& value) noexcept;

}  // namespace merlin::nn
