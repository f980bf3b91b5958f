// Emulates a Fastrak. Source: drivers/fastrak/README.md.
#pragma once

#include <memory>

#include "drivers/emulate/emulator.h"

namespace merlin::emulate {

// Makes an emulated Fastrak whose script begins at `start`. EmulatorSettings::model is the number
// of receivers, "1" (default) to "4". The first receiver is on the script's hand; each further one
// is 0.2 m to the right of the one before.
std::unique_ptr<Emulator> makeFastrak(const EmulatorSettings& settings, const MotionScript& script,
                                      Timestamp start);

}  // namespace merlin::emulate
