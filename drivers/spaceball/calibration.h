// Converts raw counts of a Spaceball to shares of full scale in MERLIN's axes. Pure.
#pragma once

#include "drivers/port/samples.h"
#include "drivers/spaceball/protocol.h"
#include "drivers/spaceball/settings.h"

namespace merlin::spaceball {

// Fills `translation`, `rotation`, `raw` and `period_us` of `sample`; leaves its other fields
// unchanged. Each axis is clamped to -1..1; counts within the dead zone give 0, and beyond it the
// scale starts at 0, so that the value is continuous at its edge.
void calibrate(const Displacement& displacement, const SpaceballSettings& settings,
               BallSample& sample) noexcept;

}  // namespace merlin::spaceball
