// Settings of the scene: the initial position of the model, and how far a person's input moves it.
#pragma once

#include <array>

#include "daemon/base/setting_fault.h"

namespace merlin::render {

struct SceneSettings {
  double model_radius_m = 1.0;    // the model is scaled to this bounding sphere
  double model_distance_m = 2.0;  // of its centre in front of the eye
  double model_yaw_deg = 0;       // turned about the vertical axis at first,
  double model_pitch_deg = 0;     // and before that about the horizontal one

  // At a full push or twist of the ball, for x, y, z.
  std::array<double, 3> ball_speed_m_s = {1.0, 1.0, 1.0};
  std::array<double, 3> ball_turn_deg_s = {90, 90, 90};
  // The wall's x (right), y (up), z (towards the person) as axes of the tracker (1 x, 2 y, 3 z,
  // negative to turn it round). As set: the transmitter's x points from the wall to the person.
  std::array<int, 3> tracker_axes = {-2, -3, 1};
  double hand_gain = 3.0;  // metres of the model for a metre of the hand
  double fly_gain = 4.0;   // metres a second of the viewer for a metre of the hand
  // Where the tracker's transmitter stands as seen from the eye (x right, y up, z towards the
  // person), and how far the wall is: what a pointing hand hits depends on both.
  std::array<double, 3> tracker_origin_m = {0, 0, 0};
  double wall_distance_m = 2.0;
  // Motion and rotation that count as noise of the tracker.
  double hand_noise_m = 0.003;
  double hand_noise_deg = 0.6;
  double still_after_s = 0.15;  // without input until the scene counts as still
  // That no wall tile has shown any of the content, after which, once nobody moves it, the start
  // view returns; 0: never.
  double return_after_s = 60;
};

// Finds an axis map that is not a right-handed permutation. Pure.
SettingFaults validate(const SceneSettings& settings);

}  // namespace merlin::render
