// Settings of the hand.
#pragma once

namespace merlin {

struct HandSettings {
  int station = 1;  // the tracker's station that is on the hand
  // Low-pass filter of the pose, against the tracker's noise: cut-off frequency for a hand at rest
  // (0: no filter), and its increase with speed [Hz per m/s].
  double cutoff_hz = 3;
  double cutoff_per_m_s = 25;
};

}  // namespace merlin
