// Settings of bindings: which input triggers which action.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

// When an action happens. kByAction: as the action requires, kHold or kEnter.
enum class When { kByAction, kEnter, kHold, kLeave };

struct Binding {
  std::string input;        // in a form of kInputForms
  std::string action = {};  // a name of kActions (daemon/base/commands.h); empty: none was given
  When when = When::kByAction;
  std::string with = {};  // another input of the same device that has to be held too; empty: none
  double after_s = 0;     // how long the input has to be held before it counts
  // Period at which an action that happens once is repeated while the input is held, from
  // kShortestRepeat_s to kLongestRepeat_s; 0: not repeated.
  double repeat_s = 0;
};

// With a shorter period, hundreds of steps would happen before a person lets go.
inline constexpr double kShortestRepeat_s = 0.05;
inline constexpr double kLongestRepeat_s = 60;

// All names of inputs, for descriptions and messages.
inline constexpr const char* kInputForms =
    "DEVICE.button.1 to DEVICE.button.12, DEVICE.key.NAME and DEVICE.button.NAME (a key or button "
    "of "
    "an input device by the kernel's name in lower case, such as key.space, button.south), "
    "DEVICE.axis.x+, x-, y+, y-, z+, z-, rx+ ... rz- (a push "
    "or "
    "twist of more than half; `merlin devices --watch` shows the name of the axis that is pushed), "
    "DEVICE.pinch and DEVICE.spread (fingers on a touch surface that "
    "have "
    "moved together or apart), DEVICE.posture.NAME, DEVICE.switch (DEVICE is the name of a device; "
    "without \"DEVICE.\" it is the input of any device), HAND.gesture.NAME (HAND is the name of a "
    "hand; without \"HAND.\" it is the gesture of any hand), and panel.button";

inline std::vector<Binding> defaultBindings() {
  return {{"posture.fist", "grab"},
          {"button.1", "reset_view"},
          {"button.2", "next_mode"},
          {"panel.button", "next_mode"}};
}

// Finds unknown inputs, chords that cannot happen, actions that cannot be combined with their
// `when` or times, and pairs of actions that one input would trigger at the same moment although
// they exclude each other, are the same, or both change what is shown or what the ball moves. Two
// bindings to one chord that name its inputs in the two orders are a fault whatever they do. A
// binding without an action is no fault here: only the caller knows whether the file gives no
// action or an unknown one. Pointers: "/INDEX/input" ... Cost: linear.
SettingFaults validate(const std::vector<Binding>& bindings);

}  // namespace merlin
