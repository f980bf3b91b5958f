// Emulates a CyberGlove with its interface unit. Source: drivers/cyberglove/README.md.
#pragma once

#include <memory>

#include "drivers/emulate/emulator.h"

namespace merlin::emulate {

// Makes an emulated CyberGlove whose script begins at `start`. EmulatorSettings::model is the
// number of sensors, "22" (default) or "18".
std::unique_ptr<Emulator> makeCyberglove(const EmulatorSettings& settings,
                                         const MotionScript& script, Timestamp start);

}  // namespace merlin::emulate
