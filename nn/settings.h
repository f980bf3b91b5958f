// Settings of PostureHold (minimum times and margin of a posture) and of DriftFollower (a glove's
// drift).
#pragma once

namespace merlin::nn {

struct HoldSettings {
  double hold_s = 0.15;        // time that a posture has to last before it begins
  double leave_s = 0.10;       // time that a posture has to be absent before it ends
  double least_margin = 0.30;  // least margin of a record, 0..1; half of it for the held posture
};

struct DriftSettings {
  // Share of a visit's mean deviation that is added to the drift; 0: off.
  double share = 0.05;
  double least_margin = 0.30;  // least margin of a hand from which drift is learned, 0..1
  double most = 0.30;          // greatest drift that is followed, share of a sensor's range
  // Least number of hands in a visit to a posture. Shorter visits are ignored, because a moving
  // hand passes through other postures.
  double least_hands = 5;
};

}  // namespace merlin::nn
