// Emulates a Spaceball 1003, 2003, 3003 or 4000 FLX. Source: drivers/spaceball/README.md.
#pragma once

#include <memory>

#include "drivers/emulate/emulator.h"

namespace merlin::emulate {

// Makes an emulated Spaceball whose script begins at `start`. EmulatorSettings::model is "2003"
// (default), "1003", "3003" or "4000".
std::unique_ptr<Emulator> makeSpaceball(const EmulatorSettings& settings,
                                        const MotionScript& script, Timestamp start);

}  // namespace merlin::emulate
