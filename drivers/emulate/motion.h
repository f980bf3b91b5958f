// MotionScript: defines what the emulated person does with glove, tracker and ball, as a function
// of time. The motion is synthetic, not recorded. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "drivers/port/samples.h"

namespace merlin::emulate {

// Measurements of all three devices at one moment.
struct Motion {
  std::array<float, kGloveSlots> glove_rad{};  // joint angles in slot order, flexion positive
  std::array<float, 3> position_m{};           // position of the hand, transmitter frame
  std::array<float, 4> orientation_wxyz{1, 0, 0, 0};
  std::array<float, 6> ball{};     // shares of full scale, in the device's axes
  std::uint32_t ball_buttons = 0;  // bit i = button i + 1
};

// Where the hand is in a phase.
struct HandPlace {
  std::array<float, 3> position_m{0.60F, 0.05F, -0.15F};  // transmitter frame
  double turn_rad = 0;                                    // rotation about its z axis
};

// Behaviour of the person during one phase. It begins with a transition from the phase before,
// which takes 0.35 s, or the whole phase if this is shorter.
struct Phase {
  double seconds = 0;           // duration
  const char* shape = "";       // shape of the hand: a name from drivers/hand/shapes
  std::array<float, 6> ball{};  // push and twist of the ball, as in Motion
  std::uint32_t buttons = 0;    // pressed buttons of the ball, as in Motion
  bool wave = false;            // whether the hand moves about its place; otherwise it is still
  HandPlace place = {};
};

struct MotionScript {
  const char* name;
  const char* help;
  std::span<const Phase> phases;  // repeated for ever
  // If not null, the caller chooses the phase: *held is its index in `phases`. If null, the time
  // determines the phase.
  const std::size_t* held = nullptr;

  // Returns the motion at time `t` after the start of the script, without noise; the emulators add
  // noise.
  Motion at(Duration t) const;
};

std::span<const MotionScript> motionScripts();
const MotionScript* findMotionScript(std::string_view name);  // nullptr if there is none

}  // namespace merlin::emulate
