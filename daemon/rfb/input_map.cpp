#include "daemon/rfb/input_map.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/commands.h"

namespace merlin::rfb {
namespace {

enum Button : unsigned { kLeft = 1, kMiddle = 2, kWheelUp = 8, kWheelDown = 16 };

// X11 keysyms
constexpr std::uint32_t kHome = 0xFF50, kArrowLeft = 0xFF51, kArrowUp = 0xFF52,
                        kArrowRight = 0xFF53, kArrowDown = 0xFF54, kPageUp = 0xFF55,
                        kPageDown = 0xFF56, kShiftLeft = 0xFFE1, kShiftRight = 0xFFE2,
                        kKeypadPlus = 0xFFAB, kKeypadMinus = 0xFFAD;

struct KeyCommand {
  std::uint32_t keysym;
  const char* command;
};
constexpr KeyCommand kKeyCommands[] = {
    {'r', "reset_view"},
    {'R', "reset_view"},
    {kHome, "reset_view"},
    {'m', "next_mode"},
    {'M', "next_mode"},
    {'n', "next_content"},
    {'N', "next_content"},
    {'s', "snapshot"},
    {'S', "snapshot"},
    {kPageDown, "next_content"},
    {'t', "next_testcard"},
    {'T', "next_testcard"},
    {'b', "blank"},
    {'B', "blank"},
    {'f', "freeze"},
    {'F', "freeze"},
    {'p', "previous_content"},
    {'P', "previous_content"},
    {kPageUp, "previous_content"},
};
static_assert(std::all_of(std::begin(kKeyCommands), std::end(kKeyCommands),
                          [](const KeyCommand& k) { return isPlainCommand(k.command); }));

constexpr double kDegreesPerHeight = 180;  // turn by a drag over the picture's height
constexpr double kRadiiPerHeight = 1.5;    // about as far as the pointer, at the default distance
constexpr double kRadiiPerNotch = 0.1;     // of the wheel, and of + and -
constexpr double kDegreesPerKey = 5, kRadiiPerKey = 0.05;
constexpr std::size_t kMostWaiting = 8, kMostHeld = 32;
// The limits of the argument of the command move.
constexpr double kMostRadii = 10, kMostDegrees = 360;

}  // namespace

// Whether the panel takes the event. It takes no event of a drag with another button, so that such
// a drag can continue over the panel.
bool InputMap::panelTakes(unsigned buttons, int x, int y) {
  const bool drags_otherwise = (buttons & ~kLeft) != 0 && (buttons & kLeft) == 0;
  return !drags_otherwise && panel_.point(x, y, (buttons & kLeft) != 0);
}

void InputMap::pointer(unsigned buttons, int x, int y, int height) {
  if (panelTakes(buttons, x, y)) {
    buttons_ = buttons;
    x_ = x;
    y_ = y;
    return;
  }
  const unsigned pressed = buttons & ~buttons_, dragged = buttons & buttons_;
  const double across = static_cast<double>(x - x_) / std::max(height, 1);
  const double down = static_cast<double>(y - y_) / std::max(height, 1);
  const bool shift = held_.count(kShiftLeft) + held_.count(kShiftRight) > 0;
  if ((dragged & kMiddle) != 0 || ((dragged & kLeft) != 0 && shift)) {
    step_.way[0] += kRadiiPerHeight * across;
    step_.way[1] -= kRadiiPerHeight * down;
  } else if ((dragged & kLeft) != 0) {
    step_.turn_deg[1] += kDegreesPerHeight * across;
    step_.turn_deg[0] += kDegreesPerHeight * down;
  }
  if ((pressed & kWheelUp) != 0) step_.way[2] += kRadiiPerNotch;
  if ((pressed & kWheelDown) != 0) step_.way[2] -= kRadiiPerNotch;
  buttons_ = buttons;
  x_ = x;
  y_ = y;
}

// Handles an arrow key, + or -; returns false for any other key. A held key repeats, because
// clients send its press again.
bool InputMap::pressesArrow(std::uint32_t keysym) {
  const bool shift = held_.count(kShiftLeft) + held_.count(kShiftRight) > 0;
  const auto act = [&](int right, int up) {
    if (shift) {
      step_.way[0] += kRadiiPerKey * right;
      step_.way[1] += kRadiiPerKey * up;
    } else {
      step_.turn_deg[1] += kDegreesPerKey * right;
      step_.turn_deg[0] -= kDegreesPerKey * up;
    }
    return true;
  };
  switch (keysym) {
    case kArrowLeft: return act(-1, 0);
    case kArrowRight: return act(1, 0);
    case kArrowUp: return act(0, 1);
    case kArrowDown: return act(0, -1);
    case '+':
    case '=':
    case kKeypadPlus: step_.way[2] += kRadiiPerNotch; return true;
    case '-':
    case kKeypadMinus: step_.way[2] -= kRadiiPerNotch; return true;
    default: return false;
  }
}

void InputMap::key(std::uint32_t keysym, bool pressed) {
  if (!pressed) {
    held_.erase(keysym);
    return;
  }
  if (pressesArrow(keysym)) return;
  if (held_.size() >= kMostHeld) held_.clear();  // a client that never releases any
  if (!held_.insert(keysym).second) return;      // the client repeats a held key
  const auto* const found = std::find_if(std::begin(kKeyCommands), std::end(kKeyCommands),
                                         [&](const KeyCommand& k) { return k.keysym == keysym; });
  if (found == std::end(kKeyCommands) || commands_.size() >= kMostWaiting) return;
  commands_.emplace_back(found->command);
}

std::optional<Request> InputMap::take() {
  if (!commands_.empty()) {
    Request request{std::move(commands_.front())};
    commands_.pop_front();
    return request;
  }
  const Step step = std::exchange(step_, {});
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    values[i] = std::clamp(step.way[i], -kMostRadii, kMostRadii);
    values[i + 3] = std::clamp(step.turn_deg[i], -kMostDegrees, kMostDegrees);
  }
  if (std::all_of(values.begin(), values.end(), [](double v) { return v == 0; }))
    return std::nullopt;
  return Request{"move", fmt::format("{:.4f} {:.4f} {:.4f} {:.3f} {:.3f} {:.3f}", values[0],
                                     values[1], values[2], values[3], values[4], values[5])};
}

}  // namespace merlin::rfb
