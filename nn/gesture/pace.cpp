#include "nn/gesture/pace.h"

#include <algorithm>
#include <cmath>

namespace merlin::nn {
namespace {

// Logarithm of the greatest speed of an unhurried reach as a linear function of the logarithm of
// its length, fitted to the synthetic people of drivers/hand.
constexpr float kSpeedAt1m = 0.60F, kSlope = 0.60F;
constexpr float kLongMemory = 15;     // number of strokes that the mean covers
constexpr float kMost = 0.4F;         // limit of one stroke's difference
constexpr float kFarthest = 0.35F;    // limit of the difference from the average person
constexpr float kShortest_m = -1.9F;  // logarithm of the shortest stroke used, 0.15 m
constexpr float kMostRoll = 0.5F;

float ratio(float log_length, float log_speed) noexcept {
  return log_speed - (kSpeedAt1m + kSlope * log_length);
}

}  // namespace

float UsualPace::hasteOf(float log_length, float log_speed) const noexcept {
  return ratio(log_length, log_speed) - usual_;
}

void UsualPace::learn(float log_length, float log_speed, float roll_share) noexcept {
  if (log_length < kShortest_m || std::abs(roll_share) > kMostRoll) return;
  strokes_ = std::min(strokes_ + 1, kLongMemory);
  usual_ += std::clamp(hasteOf(log_length, log_speed), -kMost, kMost) / strokes_;
  usual_ = std::clamp(usual_, -kFarthest, kFarthest);
}

}  // namespace merlin::nn
