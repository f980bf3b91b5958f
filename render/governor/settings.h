// Settings of the governor, which holds the frame rate.
#pragma once

#include <cstddef>

#include "daemon/base/setting_fault.h"

namespace merlin::render::governor {

struct GovernorSettings {
  double rate_hz = 30;  // frames per second while anything moves
  // Lowest frame rate that is tried while not even frames of the coarsest detail are in time; a
  // rate of less than twice this one is never lowered. [GOURLEY98] B.3: a person needs 10 frames a
  // second.
  double min_rate_hz = 10;
  // Lower limit of the budget, even if frames are late. For a content whose detail is not measured
  // in triangles, the limit is lowered to the cost at which the content is still recognisable.
  std::size_t min_triangles = 500;
  std::size_t max_triangles = 4'000'000;  // upper limit of the budget while anything moves
  std::size_t first_triangles = 10'000;   // budget before the first measurement
  double late_share = 0.01;               // share of late frames that the head room is adjusted to
};

// Reports min_triangles, first_triangles and max_triangles that are not in ascending order, with
// the JSON pointer "".
SettingFaults validate(const GovernorSettings& governor);

}  // namespace merlin::render::governor
