// The list of all commands of merlind. The sockets' commands, the actions that inputs may be bound
// to (ball buttons, postures, the panel's button), their fields in shared memory, the subcommands
// of `merlin` and the schema are made from it; daemon/role_commands.cpp and daemon/wall execute
// them.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace merlin {

// Which role of merlind executes a command. kPanel marks the commands of the control panel; the
// role `devices` executes them.
enum class CommandOf { kEachRole, kDevices, kPanel, kWall };

// Whether inputs may be bound to a command. kOnce: the command is executed when the input begins
// (or ends). kHeld: the command lasts while the input is held; it cannot be sent to a socket.
enum class Bindable { kNo, kOnce, kHeld };

struct CommandInfo {
  std::string_view name;
  CommandOf role;
  std::string_view argument;  // form of its argument, "N|auto"; empty: none
  std::string_view help;      // what it does, for a person
  Bindable bindable;
  bool by_name;  // whether `merlin NAME` sends it; otherwise another subcommand does
};

inline constexpr CommandInfo kCommands[] = {
    {"status", CommandOf::kEachRole, "", "Show the state of the role.", Bindable::kNo, false},
    {"events", CommandOf::kEachRole, "", "Show the last events of the role.", Bindable::kNo, false},
    {"reload", CommandOf::kEachRole, "now|check|NUMBER",
     "Read the configuration again and swap what changed, all or nothing (now), or only say what "
     "would be swapped (check). The answer contains the number of the request; with this NUMBER, "
     "the command says what became of that request.",
     Bindable::kNo, false},
    {"flight", CommandOf::kDevices, "",
     "Write the bytes that went to and from every device in the last minutes into files.",
     Bindable::kNo, false},
    {"reset_view", CommandOf::kWall, "",
     "Return the model and the viewer to their initial positions.", Bindable::kOnce, true},
    {"next_mode", CommandOf::kWall, "", "Switch whether the ball moves the model or the viewer.",
     Bindable::kOnce, true},
    {"next_content", CommandOf::kWall, "",
     "Show the next slide, or the next content of the configuration.", Bindable::kOnce, true},
    {"previous_content", CommandOf::kWall, "",
     "Show the previous slide, or the previous content of the configuration.", Bindable::kOnce,
     true},
    {"show", CommandOf::kWall, "NAME",
     "Show the content with this name: that of the configuration or, if it has none, that of the "
     "content folder, which keeps what `merlin show FILE` has shown.",
     Bindable::kNo, false},
    {"show_file", CommandOf::kWall, "NAME",
     "Show a model, a pyramid or a folder of pyramids from the content folder, by its name in that "
     "folder; `merlin show FILE` puts it there.",
     Bindable::kNo, false},
    {"notice", CommandOf::kWall, "TEXT|off",
     "Show a sentence over the picture for five seconds; off ends it.", Bindable::kNo, true},
    {"blank", CommandOf::kWall, "",
     "Make all outputs black at once; a second call or the next input shows the picture again.",
     Bindable::kOnce, true},
    {"freeze", CommandOf::kWall, "",
     "Freeze the picture: nothing moves it. A second call or the next input ends it.",
     Bindable::kOnce, true},
    {"playlist", CommandOf::kWall, "on|off|next",
     "Begin the playlist at once (on), keep it from beginning by itself (off), or show its next "
     "content (next).",
     Bindable::kNo, true},
    {"move", CommandOf::kWall, "X Y Z RX RY RZ",
     "Move what the ball moves, at once: X Y Z times the model's radius to the right, up and "
     "towards the viewer, and RX RY RZ degrees about these axes. A picture is not turned: 180 "
     "degrees about X or Y move it by 1.5 radii down or to the right.",
     Bindable::kNo, false},
    {"operator_panel", CommandOf::kWall, "",
     "Switch the ball between operating the panel on the operator's tile and moving what it moved "
     "before.",
     Bindable::kOnce, true},
    {"operator_pointer", CommandOf::kWall, "X Y 0|1",
     "Move the pointer of the operator's panel to a pixel of the frame, with its button pressed "
     "(1) or not (0); the argument out removes the pointer.",
     Bindable::kNo, false},
    {"snapshot", CommandOf::kWall, "",
     "Write the newest frame into the folder that /wall/snapshots names.", Bindable::kOnce, false},
    {"triangles", CommandOf::kWall, "N|auto",
     "Set the number of triangles per frame while anything moves; auto lets the governor choose "
     "it.",
     Bindable::kNo, false},
    {"rate", CommandOf::kWall, "HZ|auto",
     "Set the frame rate, 1 to 240 per second; auto returns to the configured rate.", Bindable::kNo,
     false},
    {"align", CommandOf::kWall, "REQUEST",
     "Move the corners of an output's picture; the REQUEST list shows where they are.",
     Bindable::kNo, false},
    {"testcard", CommandOf::kWall, "NAME|off",
     "Show a test card instead of the picture: grid, edges, ramps, names, focus, black, grey, "
     "white; off ends it.",
     Bindable::kNo, false},
    {"next_testcard", CommandOf::kWall, "",
     "Show the next test card, or the picture again after the last one.", Bindable::kOnce, false},
    {"signal", CommandOf::kWall, "OUTPUT",
     "Put the next frame that is sent to an output into shared memory, from where `merlin snapshot "
     "--output` reads it.",
     Bindable::kNo, false},
    {"align_output_next", CommandOf::kWall, "",
     "Choose the next output for alignment: align_left, align_right, align_up and align_down then "
     "move a corner of it.",
     Bindable::kOnce, false},
    {"align_corner_next", CommandOf::kWall, "",
     "Choose the next corner of the output that is chosen for alignment.", Bindable::kOnce, false},
    {"align_left", CommandOf::kWall, "",
     "Move the corner that is chosen for alignment to the left by one pixel.", Bindable::kOnce,
     false},
    {"align_right", CommandOf::kWall, "",
     "Move the corner that is chosen for alignment to the right by one pixel.", Bindable::kOnce,
     false},
    {"align_up", CommandOf::kWall, "",
     "Move the corner that is chosen for alignment up by one pixel.", Bindable::kOnce, false},
    {"align_down", CommandOf::kWall, "",
     "Move the corner that is chosen for alignment down by one pixel.", Bindable::kOnce, false},
    {"align_undo", CommandOf::kWall, "", "Undo the last step of the alignment.", Bindable::kOnce,
     false},
    {"align_redo", CommandOf::kWall, "", "Redo the step of the alignment that was undone last.",
     Bindable::kOnce, false},
    {"projector_on", CommandOf::kPanel, "", "Switch the projectors on.", Bindable::kOnce, true},
    {"projector_off", CommandOf::kPanel, "", "Switch the projectors off.", Bindable::kOnce, true},
    {"video_a", CommandOf::kPanel, "", "Show input A on the projectors.", Bindable::kOnce, true},
    {"video_b", CommandOf::kPanel, "", "Show input B on the projectors.", Bindable::kOnce, true},
    {"lamp_off", CommandOf::kPanel, "", "Switch the panel's lamp off.", Bindable::kOnce, true},
    {"lamp_slow", CommandOf::kPanel, "", "Let the panel's lamp blink slowly.", Bindable::kOnce,
     true},
    {"lamp_fast", CommandOf::kPanel, "", "Let the panel's lamp blink fast.", Bindable::kOnce, true},
    {"lamp_on", CommandOf::kPanel, "", "Switch the panel's lamp on.", Bindable::kOnce, true},
    {"grab", CommandOf::kWall, "", "The tracked hand moves the model.", Bindable::kHeld, false},
    {"fly", CommandOf::kWall, "", "The hand's displacement sets the viewer's speed.",
     Bindable::kHeld, false},
    {"point_at", CommandOf::kWall, "", "A mark shows where the hand points.", Bindable::kHeld,
     false},
    {"align_push", CommandOf::kWall, "",
     "Pushing the ball moves the chosen corner of the chosen output instead of the model.",
     Bindable::kHeld, false},
    {"move_left", CommandOf::kWall, "",
     "Move the model or the viewer to the left, as the ball does.", Bindable::kHeld, false},
    {"move_right", CommandOf::kWall, "",
     "Move the model or the viewer to the right, as the ball does.", Bindable::kHeld, false},
    {"move_up", CommandOf::kWall, "", "Move the model or the viewer up, as the ball does.",
     Bindable::kHeld, false},
    {"move_down", CommandOf::kWall, "", "Move the model or the viewer down, as the ball does.",
     Bindable::kHeld, false},
    {"turn_left", CommandOf::kWall, "", "Turn the model or the view to the left.", Bindable::kHeld,
     false},
    {"turn_right", CommandOf::kWall, "", "Turn the model or the view to the right.",
     Bindable::kHeld, false},
    {"turn_up", CommandOf::kWall, "", "Turn the model or the view up.", Bindable::kHeld, false},
    {"turn_down", CommandOf::kWall, "", "Turn the model or the view down.", Bindable::kHeld, false},
    {"roll_left", CommandOf::kWall, "", "Roll the model or the view to the left.", Bindable::kHeld,
     false},
    {"roll_right", CommandOf::kWall, "", "Roll the model or the view to the right.",
     Bindable::kHeld, false},
    {"zoom_in", CommandOf::kWall, "",
     "Bring what is shown nearer, to half its distance in a second.", Bindable::kHeld, false},
    {"zoom_out", CommandOf::kWall, "",
     "Move what is shown away, to twice its distance in a second.", Bindable::kHeld, false},
};

// Returns the command of that name; null if there is none.
constexpr const CommandInfo* findCommand(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                         [&](const CommandInfo& c) { return c.name == name; });
  return found == std::end(kCommands) ? nullptr : found;
}

// Whether a command of that name exists and takes no argument, so that, for example, a key can send
// it. Unlike findCommand(), whose pointer g++ 12 with sanitizers cannot compare at compile time, it
// can be used in a static_assert.
constexpr bool isPlainCommand(std::string_view name) {
  return std::any_of(std::begin(kCommands), std::end(kCommands),
                     [&](const CommandInfo& c) { return c.name == name && c.argument.empty(); });
}

// Names of all actions, as C strings. An action is a command that inputs may be bound to. An index
// into this list identifies an action only within one build.
inline constexpr auto kActions = [] {
  constexpr auto kIs = [](const CommandInfo& c) { return c.bindable != Bindable::kNo; };
  constexpr auto kCount = std::count_if(std::begin(kCommands), std::end(kCommands), kIs);
  std::array<const char*, static_cast<std::size_t>(kCount)> names{};
  std::size_t i = 0;
  for (const CommandInfo& c : kCommands) {
    if (kIs(c)) names[i++] = c.name.data();
  }
  return names;
}();

// Returns the index of an action in kActions. REQUIRES: `name` is an action; otherwise the call
// does not compile.
consteval std::size_t actionIndex(std::string_view name) {
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    if (name == kActions[i]) return i;
  }
  throw "there is no such action";
}

// Whether the action lasts while its input is held; otherwise it happens once.
constexpr bool isHeldAction(std::string_view name) {
  const CommandInfo* const command = findCommand(name);
  return command && command->bindable == Bindable::kHeld;
}

}  // namespace merlin
