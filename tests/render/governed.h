// A governor that has reached its target, shared by two tests that state each frame's cost
// literally.
#pragma once

#include "render/governor/governor.h"

namespace merlin::render::governed {

using std::chrono::milliseconds;

// 25 Hz are a period of 40 ms, of which 36 ms remain after the initial head room of a tenth.
inline const governor::GovernorSettings kSettings = {.rate_hz = 25,
                                                     .min_triangles = 100,
                                                     .max_triangles = 1'000'000,
                                                     .first_triangles = 10'000,
                                                     .late_share = 0.01};

inline governor::FrameCost frame(std::size_t triangles, Duration fixed, Duration work) {
  return {triangles, fixed, work, work > milliseconds(40)};
}

// Returns a governor at its target: 10,000 triangles take 36 ms, of which 4 ms are fixed, so there
// is nothing to adjust.
inline governor::Governor settled() {
  governor::Governor governor(kSettings);
  for (int i = 0; i < 10; ++i) governor.observe(frame(10'000, milliseconds(4), milliseconds(36)));
  return governor;
}

inline double budgetOf(const governor::Governor& governor) {
  return static_cast<double>(governor.budget());
}

}  // namespace merlin::render::governed
