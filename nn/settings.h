// Settings of the minimum time and margin of a posture.
#pragma once

namespace merlin::nn {

struct HoldSettings {
  double hold_s = 0.15;        // that a posture lasts before it counts
  double leave_s = 0.10;       // that it is gone before it ends
  double least_margin = 0.30;  // of a record that counts for a posture; while one is held, half
};

}  // namespace merlin::nn
