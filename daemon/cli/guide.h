// Guided calibration: instructs a person step by step while a device is measured.
#pragma once

#include <span>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "drivers/port/guided_step.h"

namespace merlin::cli {

// Interface of one device's calibration: reads the device's samples and evaluates each step.
class Guided {
 public:
  virtual ~Guided() = default;

  // Waits up to a quarter of a second for samples; uses them for the step only if `measuring` is
  // true. An error ends the calibration.
  virtual Result<Ok> listen(bool measuring) = 0;

  // Begins the measurement of the step with this index; discards earlier measurements of the same
  // step.
  virtual void begin(std::size_t step) = 0;

  // Ends the step and returns its result as a text for the person. An error means that the
  // measurement cannot be used; the step is then repeated.
  virtual Result<std::string> end() = 0;

  // Returns the device's current values as one line for a terminal; if it is empty, nothing is
  // shown.
  virtual std::string now() const { return {}; }
};

struct GuideTiming {
  double hold_s = 1;   // duration of the measurement of a step
  double pause_s = 0;  // time to get ready for a step; 0: wait until the person presses Enter
};

// Adds the options --hold and --pause, which every guided calibration has.
void addGuideTiming(Command app, GuideTiming& timing);

// Goes through the steps in order: prints the instruction, waits for Enter or for the pause,
// measures, and repeats the step if end() returned an error. Errors: those of listen(); the last
// error of end() if it has failed five times for one step.
Result<Ok> guide(std::span<const GuidedStep> steps, const GuideTiming& timing, Guided& guided);

}  // namespace merlin::cli
