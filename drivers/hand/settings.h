// Settings of the hand.
#pragma once

namespace merlin {

struct HandSettings {
  int station = 1;  // of the tracker, that the hand wears
  // Smoothing of the pose, against the tracker's noise: the cut-off of a hand at rest, and how much
  // it rises with speed [Hz for a m/s]; a cut-off of 0 smooths nothing.
  double cutoff_hz = 3;
  double cutoff_per_m_s = 25;
};

}  // namespace merlin
