// Determines which axes of an input device serve as the axes of a ball, and the dead zone, from
// motions that a person makes on request. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/port/axis_source.h"
#include "drivers/port/guided_step.h"

namespace merlin {

// Returns the steps: rest, then a push along each of x, y, z, then a turn about each of them.
std::span<const GuidedStep> padSteps();

// The axis that responded in a step. In the step "rest": the axis that moved the most by itself.
struct PadAnswer {
  std::string source = "none";  // the text of an AxisSource
  float deflection = 0;         // change from rest
};

// The result, as it is written into the settings.
struct PadAxes {
  std::vector<std::string> axes;  // six texts of AxisSources
  double dead_zone = 0;           // share of the full deflection
};

class GuidedPad {
 public:
  void begin(std::size_t step);  // starts or restarts a step; later readings belong to it
  void add(std::span<const AxisReading> readings);

  // Ends the current step. If nothing moved, the answer is "none", because few devices have six
  // axes. An axis that rests at one end of its range is a trigger, and forms a pair with the other
  // trigger. Errors, all kMalformed: something moved in the step "rest"; an axis moved too little;
  // two axes respond alike; the axis responded in an earlier step; the device has one trigger only,
  // or more than two.
  Result<PadAnswer> end();

  // Returns axes and dead zone for the settings; nothing if no axis responded in any step.
  // REQUIRES: each step has ended without an error.
  std::optional<PadAxes> solve() const;

 private:
  struct Axis {
    float low = 0, high = 0;  // range of the values at rest
    float strongest = 0;      // signed change from rest in the current step
    float rest() const noexcept { return (low + high) / 2; }
    bool isTrigger() const noexcept;
  };
  Result<PadAnswer> endRest() const;
  Result<std::string> sourceOf(const std::string& name, const Axis& axis) const;
  Result<Ok> checkUnused(const std::string& source) const;

  std::size_t step_ = 0;
  std::map<std::string, Axis> axes_;
  std::array<PadAnswer, 7> answers_{};
};

}  // namespace merlin
