// Settings of the scene: the initial pose of the model, and how far input devices move it.
#pragma once

#include <array>

#include "daemon/base/setting_fault.h"

namespace merlin::render::scene {

struct SceneSettings {
  double model_radius_m = 1.0;    // the model is scaled to this bounding sphere
  double model_distance_m = 2.0;  // distance of the model's centre in front of the eye
  double model_yaw_deg = 0;    // initial rotation about the vertical axis, applied after the pitch
  double model_pitch_deg = 0;  // initial rotation about the horizontal axis

  // Speeds at a full push or twist of the ball, for x, y, z.
  std::array<double, 3> ball_speed_m_s = {1.0, 1.0, 1.0};
  std::array<double, 3> ball_turn_deg_s = {90, 90, 90};
  // The tracker's axis that corresponds to each of the wall's axes x (right), y (up), z (towards
  // the person): 1 is x, 2 is y, 3 is z; negative: the opposite direction. By default the
  // transmitter's x axis points from the wall to the person.
  std::array<int, 3> tracker_axes = {-2, -3, 1};
  double hand_gain = 3.0;  // distance that the model moves when the hand moves by 1 m [m]
  double fly_gain = 4.0;   // speed of the viewer when the hand is 1 m from where it began [m/s]
  // Position of the tracker's transmitter relative to the eye (x right, y up, z towards the
  // person), and distance from the eye to the wall. Both determine what a pointing hand points at.
  std::array<double, 3> tracker_origin_m = {0, 0, 0};
  double wall_distance_m = 2.0;
  // Translation and rotation up to which motion counts as noise of the tracker.
  double hand_noise_m = 0.003;
  double hand_noise_deg = 0.6;
  double still_after_s = 0.15;  // time without input after which the scene counts as still
  // Time during which no tile of the wall has shown any part of the content, after which the start
  // view returns if nobody moves the content; 0: never.
  double return_after_s = 60;
};

// Reports tracker_axes that are not a right-handed signed permutation of 1, 2, 3. Pure.
SettingFaults validate(const SceneSettings& settings);

}  // namespace merlin::render::scene
