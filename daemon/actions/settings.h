// Settings of bindings, which say which input triggers which action.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

// When an action happens: when its input begins (kEnter), while it is held (kHold), or when it ends
// (kLeave). kByAction: kHold for an action that is held, otherwise kEnter.
enum class When { kByAction, kEnter, kHold, kLeave };

struct Binding {
  std::string input;  // name of the input, in one of the forms of kInputForms
  // A name of kActions (daemon/base/commands.h); empty: the file gives none, or an unknown one.
  std::string action = {};
  When when = When::kByAction;
  std::string with = {};  // another input of the same device that must be held too; empty: none
  double after_s = 0;     // time for which the input must be held before it counts
  // Period with which the action is repeated while the input is held, from kShortestRepeat_s to
  // kLongestRepeat_s; 0: it is not repeated. Only for an action that happens once, when its input
  // begins.
  double repeat_s = 0;
};

// Limits of Binding::repeat_s. With a shorter period, hundreds of repetitions would happen before a
// person lets go.
inline constexpr double kShortestRepeat_s = 0.05;
inline constexpr double kLongestRepeat_s = 60;

// All forms of names of inputs, for descriptions and messages.
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

// Returns the faults of bindings: unknown inputs; chords that cannot happen; actions that cannot be
// combined with their `when`, after_s or repeat_s; and pairs of bindings that one input would
// trigger at the same moment although their actions are the same, exclude each other, or both
// change what is shown or what the ball moves. Two bindings to the same chord with the same after_s
// that name its two inputs in opposite order are always a fault. A binding without an action is no
// fault here, since only the caller knows whether the file gives no action or an unknown one. JSON
// pointers of the faults are relative to the list: "/INDEX/input" etc. Cost: linear.
SettingFaults validate(const std::vector<Binding>& bindings);

}  // namespace merlin
