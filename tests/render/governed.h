// A governor at its target, as two tests begin with it, on frames whose cost is said literally.
#pragma once

#include "render/governor/governor.h"

namespace merlin::render::governed {

using std::chrono::milliseconds;

// 25 Hz, a period of 40 ms: 36 ms but for the head room that it starts with.
inline const GovernorSettings kSettings = {.rate_hz = 25,
                                           .min_triangles = 100,
                                           .max_triangles = 1'000'000,
                                           .first_triangles = 10'000,
                                           .late_share = 0.01};

inline FrameCost frame(std::size_t triangles, Duration fixed, Duration work) {
  return {triangles, fixed, work, work > milliseconds(40)};
}

// At its target: 10,000 triangles take 36 ms, 4 of them fixed. Nothing is left to change.
inline Governor settled() {
  Governor governor(kSettings);
  for (int i = 0; i < 10; ++i) governor.observe(frame(10'000, milliseconds(4), milliseconds(36)));
  return governor;
}

inline double budgetOf(const Governor& governor) { return static_cast<double>(governor.budget()); }

}  // namespace merlin::render::governed
