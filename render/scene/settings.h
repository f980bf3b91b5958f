// What the configuration says of the scene: where the model stands, and what a person's input does.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin::render {

// What an input can do.
enum class Action {
  kGrab,         // while it is held: the tracked hand moves the model
  kResetView,    // once: model and viewer back to where they started
  kNextMode,     // once: the ball moves the model, or the viewer
  kFly,          // while it is held: the way of the hand from where it began is the viewer's speed
  kPointAt,      // while it is held: a mark on the wall, where the hand points
  kNextContent,  // once: the next model, where the first one stood at the start
  kSnapshot,     // once: the frame as a file
  kLampOff,      // once, and the next three: the panel's status lamp
  kLampSlow,
  kLampFast,
  kLampOn,
};

inline constexpr const char* kActionNames[] = {"grab",      "reset_view",   "next_mode", "fly",
                                               "point_at",  "next_content", "snapshot",  "lamp_off",
                                               "lamp_slow", "lamp_fast",    "lamp_on"};
inline constexpr const char* nameOf(Action a) { return kActionNames[static_cast<int>(a)]; }

inline constexpr bool lasts(Action a) {
  return a == Action::kGrab || a == Action::kFly || a == Action::kPointAt;
}
inline constexpr bool isLamp(Action a) { return a >= Action::kLampOff; }
// Whether no single moment may do both: one hand does one thing at a time, and there is one lamp.
inline constexpr bool exclude(Action a, Action b) {
  return a == b || (lasts(a) && lasts(b)) || (isLamp(a) && isLamp(b));
}

// When it does it: what lasts does it while the input is held, what happens once when it begins.
enum class When { kByAction, kEnter, kHold, kLeave };

// "ball.button.1" ... "ball.button.12", "posture.NAME", "glove.switch".
struct Binding {
  std::string input;
  Action action = Action::kGrab;
  When when = When::kByAction;
};

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
  int hand_station = 1;    // of the tracker, that the grabbing hand wears
  double hand_gain = 3.0;  // metres of the model for a metre of the hand
  double fly_gain = 4.0;   // metres a second of the viewer for a metre of the hand
  // Where the tracker's transmitter stands as seen from the eye (x right, y up, z towards the
  // person), and how far the wall is: what a pointing hand hits depends on both.
  std::array<double, 3> tracker_origin_m = {0, 0, 0};
  double wall_distance_m = 2.0;
  // What the tracker's own noise may look like; less is no motion.
  double hand_noise_m = 0.003;
  double hand_noise_deg = 0.6;
  double still_after_s = 0.15;   // without input until the scene counts as still
  double posture_hold_s = 0.10;  // that a posture lasts before it acts
  double stale_after_s = 0.5;    // of a device that is no longer well, its input ends
  // That no wall tile has shown any of the content, after which, once nobody moves it, the start
  // view returns; 0: never.
  double return_after_s = 60;

  std::vector<Binding> bindings = {{"posture.fist", Action::kGrab},
                                   {"ball.button.1", Action::kResetView},
                                   {"ball.button.2", Action::kNextMode}};
};

// What no scene can be made of: an axis map that is no right-handed permutation. What single
// bindings can have wrong, config/checks finds. Pure.
SettingFaults validate(const SceneSettings& settings);

}  // namespace merlin::render
