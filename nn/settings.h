// Settings of the minimum time and margin of a posture.
#pragma once

namespace merlin::nn {

struct HoldSettings {
  double hold_s = 0.15;   // time that a posture has to last before it begins
  double leave_s = 0.10;  // time that it has to be absent before it ends
  double least_margin =
      0.30;  // least margin of a record that counts; half of it while a posture is held
};

}  // namespace merlin::nn
