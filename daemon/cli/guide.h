// A guided calibration: a person is told what to do, step by step, and is measured while doing it.
#pragma once

#include <span>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "drivers/port/guided_step.h"

namespace merlin::cli {

// What is calibrated: where its samples come from, and what is made of them.
class Guided {
 public:
  virtual ~Guided() = default;

  // Waits for samples, up to a quarter of a second; they count where `measuring`. An error ends the
  // calibration.
  virtual Result<Ok> listen(bool measuring) = 0;

  // What is measured from now on belongs to that step; again: anew.
  virtual void begin(std::size_t step) = 0;

  // What was measured, for the person to read; an error has the step done again.
  virtual Result<std::string> end() = 0;

  // What is heard at this moment, one line for a terminal; empty: nothing is shown.
  virtual std::string now() const { return {}; }
};

struct GuideTiming {
  double hold_s = 1;
  double pause_s = 0;  // 0: Enter begins a step
};

// The options --hold and --pause, which every guided calibration has.
void addGuideTiming(Command app, GuideTiming& timing);

// Every step in its order: says what to do, waits for Enter or for the pause, measures, and has it
// done again where it was refused. Errors: listen()'s; end()'s of a step that was refused five
// times.
Result<Ok> guide(std::span<const GuidedStep> steps, const GuideTiming& timing, Guided& guided);

}  // namespace merlin::cli
