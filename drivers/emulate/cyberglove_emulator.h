// Emulates a CyberGlove with its interface unit. Source: drivers/cyberglove/README.md.
#pragma once

#include <memory>

#include "drivers/emulate/emulator.h"

namespace merlin::emulate {

// Models: "22" or "18" sensors.
std::unique_ptr<Emulator> makeCyberglove(const EmulatorSettings& settings,
                                         const MotionScript& script, Timestamp start);

}  // namespace merlin::emulate
