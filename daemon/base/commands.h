// The list of all commands of merlind. The sockets' commands, the commands of the panel's button,
// the subcommands of `merlin` and the schema are made from it; daemon/role_commands.cpp implements
// them.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace merlin {

// The role of merlind that executes a command; the role devices executes the panel's.
enum class CommandOf { kEachRole, kDevices, kPanel, kWall };

struct CommandInfo {
  std::string_view name;
  CommandOf role;
  std::string_view argument;  // form of its argument, "N|auto"; empty: none
  std::string_view help;      // what it does, for a person
  bool by_button;             // whether the panel's button may be set to it
  bool by_name;               // whether `merlin NAME` sends it; otherwise another subcommand does
};

inline constexpr CommandInfo kCommands[] = {
    {"status", CommandOf::kEachRole, "", "Show the state of the role.", false, false},
    {"flight", CommandOf::kDevices, "",
     "Write the last minutes of every device's bytes into files.", false, false},
    {"reset_view", CommandOf::kWall, "",
     "Return the model and the viewer to their initial positions.", true, true},
    {"next_mode", CommandOf::kWall, "", "Switch whether the ball moves the model or the viewer.",
     true, true},
    {"next_content", CommandOf::kWall, "", "Show the next model of the configuration.", true, true},
    {"snapshot", CommandOf::kWall, "",
     "Write the newest frame into the folder that /wall/snapshots names.", true, false},
    {"triangles", CommandOf::kWall, "N|auto",
     "Set the number of triangles per frame while anything moves; auto lets the governor choose "
     "it.",
     false, false},
    {"rate", CommandOf::kWall, "HZ|auto",
     "Set the frame rate, 1 to 240 per second; auto returns to the configured rate.", false, false},
    {"projector_on", CommandOf::kPanel, "", "Switch the projectors on.", true, true},
    {"projector_off", CommandOf::kPanel, "", "Switch the projectors off.", true, true},
    {"video_a", CommandOf::kPanel, "", "Show input A on the projectors.", true, true},
    {"video_b", CommandOf::kPanel, "", "Show input B on the projectors.", true, true},
    {"lamp_off", CommandOf::kPanel, "", "Switch the panel's lamp off.", false, true},
    {"lamp_slow", CommandOf::kPanel, "", "Let the panel's lamp blink slowly.", false, true},
    {"lamp_fast", CommandOf::kPanel, "", "Let the panel's lamp blink fast.", false, true},
    {"lamp_on", CommandOf::kPanel, "", "Switch the panel's lamp on.", false, true},
};

// The command of that name; null if there is none.
constexpr const CommandInfo* findCommand(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                         [&](const CommandInfo& c) { return c.name == name; });
  return found == std::end(kCommands) ? nullptr : found;
}

// Names of the commands that the panel's button may be set to, as C strings.
inline constexpr auto kButtonCommands = [] {
  constexpr auto kIs = [](const CommandInfo& c) { return c.by_button; };
  constexpr auto kCount = std::count_if(std::begin(kCommands), std::end(kCommands), kIs);
  std::array<const char*, static_cast<std::size_t>(kCount)> names{};
  std::size_t i = 0;
  for (const CommandInfo& c : kCommands) {
    if (kIs(c)) names[i++] = c.name.data();
  }
  return names;
}();

}  // namespace merlin
