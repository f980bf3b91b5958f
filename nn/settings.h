// Settings of the minimum time and margin of a posture, and of following a glove's drift.
#pragma once

namespace merlin::nn {

struct HoldSettings {
  double hold_s = 0.15;        // time that a posture has to last before it begins
  double leave_s = 0.10;       // time that it has to be absent before it ends
  double least_margin = 0.30;  // least margin of a record; half while a posture is held
};

struct DriftSettings {
  double share = 0.05;         // share of a visit's mean deviation taken for drift; 0: off
  double least_margin = 0.30;  // least margin of a hand to learn from
  double most = 0.30;          // most drift that is followed, share of a sensor's range
  double least_hands = 5;      // minimum of a visit: a moving hand passes other postures
};

}  // namespace merlin::nn
