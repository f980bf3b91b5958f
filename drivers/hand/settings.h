// Settings of a hand, which combines a glove and a tracker.
#pragma once

#include <string>

namespace merlin {

struct HandSettings {
  std::string name = "hand";  // name of its slot in shared memory; unique among hands and devices
  std::string person;         // whose hand it is, as in the settings of devices
  std::string glove;          // name of the hand's glove; empty: the first glove; kNoGlove: none
  std::string tracker;        // name of the tracker that follows it; empty: the first tracker
  std::string buttons;        // name of the ball whose buttons the hand holds; empty: none
  int station = 1;            // the tracker's station that is on the hand
  bool gestures = true;       // whether its gestures are recognised
  // Low-pass filter of the pose, against the tracker's noise: cut-off frequency for a hand at rest
  // (0: no filter), and its increase with speed [Hz per m/s].
  double cutoff_hz = 3;
  double cutoff_per_m_s = 25;

  static constexpr const char* kNoGlove = "none";  // hand with a wand; no device has this name
  bool wearsGlove() const { return glove != kNoGlove; }
};

}  // namespace merlin
