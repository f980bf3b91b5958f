// The commands that a merlind carries out: one list. The sockets' commands, what the panel's button
// may do, the subcommands of `merlin` and the schema come from it; daemon/role_commands.cpp has
// what each one does.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace merlin {

// Which role of merlind takes a command; the panel's are taken by the role devices.
enum class CommandOf { kEachRole, kDevices, kPanel, kWall };

struct CommandInfo {
  std::string_view name;
  CommandOf role;
  std::string_view argument;  // its form, "N|auto"; empty: it takes none
  std::string_view help;      // for a person: what it does
  bool by_button;             // the panel's button may be set to it
  bool by_name;               // `merlin NAME` sends it; else another subcommand does
};

inline constexpr CommandInfo kCommands[] = {
    {"status", CommandOf::kEachRole, "", "Tell how the role is.", false, false},
    {"flight", CommandOf::kDevices, "",
     "Write the last minutes of every device's bytes into files.", false, false},
    {"reset_view", CommandOf::kWall, "", "Put the model and the viewer back to the start.", true,
     true},
    {"next_mode", CommandOf::kWall, "",
     "Let the ball move the viewer instead of the model, or back.", true, true},
    {"next_content", CommandOf::kWall, "", "Show the next of the configuration's models.", true,
     true},
    {"snapshot", CommandOf::kWall, "", "Write the newest frame into the folder /wall/snapshots.",
     true, false},
    {"triangles", CommandOf::kWall, "N|auto",
     "Draw this many triangles while anything moves, or let the governor decide.", false, false},
    {"rate", CommandOf::kWall, "HZ|auto",
     "Draw this many frames a second, from 1 to 240, or as many as configured.", false, false},
    {"projector_on", CommandOf::kPanel, "", "Switch the projectors on.", true, true},
    {"projector_off", CommandOf::kPanel, "", "Switch the projectors off.", true, true},
    {"video_a", CommandOf::kPanel, "", "Show input A on the projectors.", true, true},
    {"video_b", CommandOf::kPanel, "", "Show input B on the projectors.", true, true},
    {"lamp_off", CommandOf::kPanel, "", "Switch the panel's lamp off.", false, true},
    {"lamp_slow", CommandOf::kPanel, "", "Let the panel's lamp blink slowly.", false, true},
    {"lamp_fast", CommandOf::kPanel, "", "Let the panel's lamp blink fast.", false, true},
    {"lamp_on", CommandOf::kPanel, "", "Switch the panel's lamp on.", false, true},
};

// Null where there is none of that name.
constexpr const CommandInfo* findCommand(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                         [&](const CommandInfo& c) { return c.name == name; });
  return found == std::end(kCommands) ? nullptr : found;
}

// The names of those that the panel's button may be set to, as C strings.
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
