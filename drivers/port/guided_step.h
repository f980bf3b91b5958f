// What a person is asked to do at one step of a guided calibration.
#pragma once

namespace merlin {

struct GuidedStep {
  const char* name;
  const char* instruction;
};

}  // namespace merlin
