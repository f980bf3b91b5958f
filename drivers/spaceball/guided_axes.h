// Determines a ball's axis map, dead zone and full scales from pushes and twists that a person
// makes on request. Pure.
#pragma once

#include <array>
#include <span>

#include "daemon/base/result.h"
#include "drivers/port/guided_step.h"
#include "drivers/port/samples.h"
#include "drivers/spaceball/settings.h"

namespace merlin::spaceball {

// Returns the steps: rest, then a push along each of x, y, z, then a twist about each of them.
std::span<const GuidedStep> axesSteps();

// The ball's axis with the largest response: 1..6 (X Y Z A B C), negative if it is reversed, and
// its raw counts; also the axis of the same kind (push or twist) with the second largest response.
struct AxisAnswer {
  int axis = 0, counts = 0;
  int next_axis = 0, next_counts = 0;
};
char nameOfAxis(int axis) noexcept;  // 'X' for 1 and -1, ... 'C' for 6 and -6

// How strongly a kind of ball responds to a person, in raw counts.
struct BallResponse {
  int push_of_twist;            // counts of a full push divided by those of a full twist
  int least_push, least_twist;  // below these, the person is asked to push or twist harder
};
// A Spaceball's pushes give five times as many counts as its twists; the default full scales have
// the same ratio (README.md, "Quirks").
inline constexpr BallResponse kSpaceballResponse = {5, 400, 80};
// Space mice send at most 350 counts of each axis; see SpacenavSettings::full_scale.
inline constexpr BallResponse kSpaceMouseResponse = {1, 120, 120};

// Uses raw counts only, which do not depend on axis map, dead zone and full scale of the present
// settings.
class GuidedAxes {
 public:
  explicit GuidedAxes(const BallResponse& response = kSpaceballResponse) : response_(response) {}

  void begin(std::size_t step);  // starts or restarts a step; later samples belong to it
  void add(const BallSample& sample);

  // Ends the current step. A ball that sends nothing is at rest. Errors, all kMalformed: the ball
  // was touched in the step "rest"; it was pushed too little; two axes respond alike; it was
  // twisted instead of pushed, or vice versa; the axis already responded in an earlier step.
  Result<AxisAnswer> end();

  // Returns `settings` with a new axis map, dead zone (four counts plus twice the largest count at
  // rest) and full scales (nine tenths of the weakest of three axes, so that each axis can reach
  // full scale). REQUIRES: each step has ended without an error.
  SpaceballSettings solve(const SpaceballSettings& settings) const;

 private:
  Result<Ok> check(const AxisAnswer& answer) const;
  int strength(int axis, int counts) const noexcept;

  BallResponse response_;
  std::size_t step_ = 0;
  std::array<int, 6> strongest_{};  // in the current step, signed raw counts
  std::array<AxisAnswer, 7> answers_{};
};

}  // namespace merlin::spaceball
