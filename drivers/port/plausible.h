// Checks whether a device can have measured the values of a sample. Pure; for samples that come
// from another machine or program. A driver's protocol checks the records that it reads against the
// same limits or narrower ones.
#pragma once

#include "drivers/port/samples.h"

namespace merlin {

// Reach of a Fastrak's receiver from its transmitter: 3.05 m (10 ft), with the long-range
// transmitter 4.57 m (15 ft), and a margin. Sources: MAN12 of drivers/fastrak for the former, the
// vendor's data sheet of the Long Ranger for the latter.
inline constexpr float kTrackerReach_m = 5;
// Largest coordinate of a tracker's sample: the reach, plus the farthest origin that a
// configuration can set (10 m along each axis), plus the stylus's tip (1 m along each).
inline constexpr float kFurthest_m = 25;

// Return false if a number is NaN, infinite or out of its range, if the norm of a quaternion is
// outside 0.98..1.02, or if a code, letter or text is invalid. Counters and times are not checked.
bool plausible(const GloveSample& sample) noexcept;
bool plausible(const TrackerSample& sample) noexcept;
bool plausible(const BallSample& sample) noexcept;
bool plausible(const TouchSample& sample) noexcept;
bool plausible(const PostureSample& sample) noexcept;
bool plausible(const HandSample& sample) noexcept;

}  // namespace merlin
