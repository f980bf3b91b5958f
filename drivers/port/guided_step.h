// One step of a guided calibration: the text for the person.
#pragma once

namespace merlin {

struct GuidedStep {
  const char* name;
  const char* instruction;
};

}  // namespace merlin
