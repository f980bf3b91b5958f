// Emulates a Fastrak. Source: drivers/fastrak/README.md.
#pragma once

#include <memory>

#include "drivers/emulate/emulator.h"

namespace merlin::emulate {

// Models: "1".."4" receivers. The first is on the script's hand, each further one 0.2 m to its
// right.
std::unique_ptr<Emulator> makeFastrak(const EmulatorSettings& settings, const MotionScript& script,
                                      Timestamp start);

}  // namespace merlin::emulate
