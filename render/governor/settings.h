// Settings of the frame rate.
#pragma once

#include <cstddef>

#include "daemon/base/setting_fault.h"

namespace merlin::render {

struct GovernorSettings {
  double rate_hz = 30;                    // frames a second while anything moves
  std::size_t min_triangles = 500;        // never fewer, however late
  std::size_t max_triangles = 4'000'000;  // never more while moving
  std::size_t first_triangles = 10'000;   // before anything was measured
  double late_share = 0.01;               // of frames, that the head room is learnt for
};

// Finds numbers of triangles that are not in ascending order. Pointer: "".
SettingFaults validate(const GovernorSettings& governor);

}  // namespace merlin::render
