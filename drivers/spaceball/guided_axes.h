// A ball's axis map and sensitivities, from pushes and twists that a person is asked for. Pure.
#pragma once

#include <array>
#include <span>

#include "daemon/base/result.h"
#include "drivers/port/guided_step.h"
#include "drivers/port/samples.h"
#include "drivers/spaceball/settings.h"

namespace merlin::spaceball {

// First rest, then a push along x, y, z and a twist about each.
std::span<const GuidedStep> axesSteps();

// Which of the ball's axes answered the most: 1..6 (X Y Z A B C), negative where it was turned
// round, and by how many raw counts; the same of the next one of its kind.
struct AxisAnswer {
  int axis = 0, counts = 0;
  int next_axis = 0, next_counts = 0;
};
char nameOfAxis(int axis) noexcept;  // 'X' for 1 and -1

// Takes raw counts alone: neither axis map, dead zone nor full scale of the present settings are in
// them.
class GuidedAxes {
 public:
  void begin(std::size_t step);  // what comes from now on belongs to it; again: anew
  void add(const BallSample& sample);

  // The step under way. A ball that is silent is at rest. Errors, all kMalformed: touched while at
  // rest; pushed too little; two axes answer alike; twisted in place of pushed, or the other way
  // round; an axis that has answered an earlier step.
  Result<AxisAnswer> end();

  // Dead zone: twice what was seen at rest and four counts. Full scale: nine tenths of the weakest
  // of the three, so that each can be reached. Else as `settings`.
  // REQUIRES: each step has ended well.
  SpaceballSettings solve(const SpaceballSettings& settings) const;

 private:
  Result<Ok> check(const AxisAnswer& answer) const;

  std::size_t step_ = 0;
  std::array<int, 6> strongest_{};  // of the step under way, raw counts with their sign
  std::array<AxisAnswer, 7> answers_{};
};

}  // namespace merlin::spaceball
