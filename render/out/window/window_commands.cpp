#include "render/out/window/window_commands.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/commands.h"

namespace merlin::render::out {
namespace {

// Limits of the arguments of one command `move`.
constexpr double kMostRadii = 10, kMostDegrees = 360;
// Turn and shift of a drag over the whole height of the window; merlin-rfb uses the same values.
constexpr double kDegreesPerHeight = 180, kRadiiPerHeight = 1.5;
constexpr double kRadiiPerNotch = 0.1;
constexpr double kDegreesPerKey = 5, kRadiiPerKey = 0.05;

struct Key {
  std::string_view key, command;
  bool repeats = false;
};
constexpr Key kKeys[] = {{"Home", "reset_view"},
                         {"R", "reset_view"},
                         {"M", "next_mode"},
                         {"PageDown", "next_content"},
                         {"N", "next_content"},
                         {"PageUp", "previous_content"},
                         {"P", "previous_content"},
                         {"S", "snapshot"},
                         {"T", "next_testcard"},
                         {"B", "blank"},
                         {"F", "freeze"}};
// Keys that are pressed with Ctrl; they are those of `merlin wall align`.
constexpr Key kCtrlKeys[] = {{"N", "align_output_next"},
                             {"Tab", "align_corner_next"},
                             {"Left", "align_left", true},
                             {"H", "align_left", true},
                             {"Right", "align_right", true},
                             {"L", "align_right", true},
                             {"Up", "align_up", true},
                             {"K", "align_up", true},
                             {"Down", "align_down", true},
                             {"J", "align_down", true},
                             {"U", "align_undo"},
                             {"R", "align_redo"},
                             {"T", "next_testcard"}};
constexpr bool isCommand(const Key& k) { return isPlainCommand(k.command); }
static_assert(std::ranges::all_of(kKeys, isCommand) && std::ranges::all_of(kCtrlKeys, isCommand));

}  // namespace

void WindowCommands::drag(Drag what, double right_px, double down_px, int window_height) {
  const double heights = 1.0 / std::max(1, window_height);
  if (what == Drag::kTurn) {
    motion_.about_y_deg += kDegreesPerHeight * right_px * heights;
    motion_.about_x_deg += kDegreesPerHeight * down_px * heights;
  } else {
    motion_.right += kRadiiPerHeight * right_px * heights;
    motion_.up -= kRadiiPerHeight * down_px * heights;
  }
}

void WindowCommands::wheel(double notches) { motion_.nearer += kRadiiPerNotch * notches; }

// Returns false if the key moves nothing.
bool WindowCommands::moves(const PressedKey& key) {
  struct Arrow {
    std::string_view name;
    int right, up;
  };
  constexpr Arrow kArrows[] = {{"Left", -1, 0}, {"Right", 1, 0}, {"Up", 0, 1}, {"Down", 0, -1}};
  for (const Arrow& arrow : kArrows) {
    if (arrow.name != key.name) continue;
    motion_.right += key.shift ? kRadiiPerKey * arrow.right : 0;
    motion_.up += key.shift ? kRadiiPerKey * arrow.up : 0;
    motion_.about_y_deg += key.shift ? 0 : kDegreesPerKey * arrow.right;
    motion_.about_x_deg -= key.shift ? 0 : kDegreesPerKey * arrow.up;
    return true;
  }
  const bool nearer = key.name == "+" || key.name == "=" || key.name == "Keypad +";
  const bool farther = key.name == "-" || key.name == "Keypad -";
  if (nearer || farther) wheel(nearer ? 1 : -1);
  return nearer || farther;
}

void WindowCommands::press(const PressedKey& key) {
  if (!key.ctrl && moves(key)) return;
  const std::span<const Key> keys = key.ctrl ? std::span<const Key>(kCtrlKeys) : kKeys;
  const auto found = std::ranges::find(keys, key.name, &Key::key);
  if (found == keys.end() || (key.repeats && !found->repeats)) return;
  commands_.emplace_back(found->command);
}

std::vector<std::string> WindowCommands::take() {
  const Motion m = std::exchange(motion_, {});
  const auto radii = [](double v) { return std::clamp(v, -kMostRadii, kMostRadii); };
  const auto degrees = [](double v) { return std::clamp(v, -kMostDegrees, kMostDegrees); };
  const bool moved =
      m.right != 0 || m.up != 0 || m.nearer != 0 || m.about_x_deg != 0 || m.about_y_deg != 0;
  if (moved) {
    commands_.push_back(fmt::format("move {:.4f} {:.4f} {:.4f} {:.3f} {:.3f} 0", radii(m.right),
                                    radii(m.up), radii(m.nearer), degrees(m.about_x_deg),
                                    degrees(m.about_y_deg)));
  }
  return std::exchange(commands_, {});
}

}  // namespace merlin::render::out
