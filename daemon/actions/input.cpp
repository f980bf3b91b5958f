#include "daemon/actions/input.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <utility>

#include "daemon/actions/pinch.h"
#include "drivers/port/axis_names.h"

namespace merlin::actions {
namespace {

constexpr unsigned kMostButtons = 12;
constexpr SampleKind kDeviceKinds[] = {SampleKind::kGlove, SampleKind::kTracker, SampleKind::kBall,
                                       SampleKind::kTouch};

std::optional<std::uint32_t> buttonBit(std::string_view number) {
  unsigned button = 0;
  const char* const end = number.data() + number.size();
  const auto parsed = std::from_chars(number.data(), end, button);
  if (parsed.ec != std::errc() || parsed.ptr != end || button < 1 || button > kMostButtons)
    return std::nullopt;
  return 1U << (button - 1);
}

// If `name` is PART... or DEVICE.PART..., where PART is `part`, removes everything up to the end of
// PART from `name`, and returns DEVICE (a-z, 0-9 and _) or, if there is none, an empty text.
// Otherwise returns nothing and does not change `name`. For "left.posture.fist" and "posture.",
// returns "left" and leaves "fist".
std::optional<std::string> takeDevice(std::string_view& name, std::string_view part) {
  if (name.starts_with(part)) {
    name.remove_prefix(part.size());
    return std::string();
  }
  const std::size_t dot = name.find('.');
  if (dot == 0 || dot == std::string_view::npos || !name.substr(dot + 1).starts_with(part))
    return std::nullopt;
  std::string device(name.substr(0, dot));
  const auto allowed = [](char c) {
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  if (!std::all_of(device.begin(), device.end(), allowed)) return std::nullopt;
  name.remove_prefix(dot + 1 + part.size());
  return device;
}

// Returns the bit of pushedAxes() for a direction such as "x+" or "rz-"; nothing if there is none.
std::optional<std::uint32_t> axisBit(std::string_view name) {
  if (name.empty() || (name.back() != '+' && name.back() != '-')) return std::nullopt;
  const std::string_view axis = name.substr(0, name.size() - 1);
  const auto* const found = std::find(std::begin(kAxisNames), std::end(kAxisNames), axis);
  if (found == std::end(kAxisNames)) return std::nullopt;
  const auto index = static_cast<unsigned>(found - std::begin(kAxisNames));
  return 1U << (kMostButtons + 2 * index + (name.back() == '-' ? 1 : 0));
}

// Returns the index (0 to 5) of the axis to which a bit of pushedAxes() belongs; each axis has two
// bits. Nothing if it is the bit of a button.
std::optional<unsigned> axisOf(std::uint32_t bit) {
  const auto place = static_cast<unsigned>(std::countr_zero(bit));
  if (place < kMostButtons) return std::nullopt;
  return (place - kMostButtons) / 2;
}

std::optional<Input> axis(std::string_view name) {
  const auto device = takeDevice(name, "axis.");
  const auto bit = device ? axisBit(name) : std::nullopt;
  if (!bit) return std::nullopt;
  return Input{Input::Kind::kButton, *device, *bit, {}};
}

std::optional<Input> button(std::string_view name) {
  const auto device = takeDevice(name, "button.");
  const auto bit = device ? buttonBit(name) : std::nullopt;
  if (!bit) return std::nullopt;
  return Input{Input::Kind::kButton, *device, *bit, {}};
}

// Whether the text may be a kernel's name of a key or, if `is_button`, of a button. The name of a
// button must begin with a letter, since numbers stand for the buttons of a device's own list.
bool isKeyName(std::string_view name, bool is_button) {
  const auto allowed = [](char c) {
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed) &&
         (!is_button || (name[0] >= 'a' && name[0] <= 'z'));
}

std::optional<Input> key(std::string_view name) {
  const auto device = takeDevice(name, "key.");
  if (!device || !isKeyName(name, false)) return std::nullopt;
  return Input{Input::Kind::kKey, *device, 0, "key_" + std::string(name)};
}

std::optional<Input> namedButton(std::string_view name) {
  const auto device = takeDevice(name, "button.");
  if (!device || !isKeyName(name, true)) return std::nullopt;
  return Input{Input::Kind::kKey, *device, 0, "btn_" + std::string(name)};
}

// Parses "pinch" (fingers move together) and "spread" (fingers move apart).
std::optional<Input> pinch(std::string_view name) {
  for (const auto& [word, bit] :
       {std::pair{"pinch", Pinch::kTogether}, std::pair{"spread", Pinch::kApart}}) {
    std::string_view rest = name;
    const auto device = takeDevice(rest, word);
    if (device && rest.empty()) return Input{Input::Kind::kPinch, *device, bit, {}};
  }
  return std::nullopt;
}

std::optional<Input> posture(std::string_view name) {
  const auto device = takeDevice(name, "posture.");
  if (!device || name.empty()) return std::nullopt;
  return Input{Input::Kind::kPosture, *device, 0, std::string(name)};
}

std::optional<Input> gesture(std::string_view name) {
  const auto hand = takeDevice(name, "gesture.");
  if (!hand || name.empty()) return std::nullopt;
  return Input{Input::Kind::kGesture, *hand, 0, std::string(name)};
}

std::optional<Input> wristSwitch(std::string_view name) {
  const auto device = takeDevice(name, "switch");
  if (!device || !name.empty()) return std::nullopt;
  return Input{Input::Kind::kWristSwitch, *device, 0, {}};
}

}  // namespace

bool Input::isOf(const Source& source) const {
  if (!source.kind && !source.hand) return kind == Kind::kPanelButton;
  if (!device.empty() && device != source.name) return false;
  if (source.hand) return kind == Kind::kGesture;
  if (*source.kind == SampleKind::kBall) return kind == Kind::kButton || kind == Kind::kKey;
  if (*source.kind == SampleKind::kTouch) return kind == Kind::kKey || kind == Kind::kPinch;
  return *source.kind == SampleKind::kGlove &&
         (kind == Kind::kPosture || kind == Kind::kWristSwitch);
}

bool Input::overlaps(const Input& other) const {
  return kind == other.kind && button == other.button && name == other.name &&
         (device.empty() || other.device.empty() || device == other.device);
}

bool Input::rulesOut(const Input& other) const {
  const auto hasBoth = [&](SampleKind device_kind) {
    const Source source{device, device_kind};
    return isOf(source) && other.isOf(source);
  };
  if (std::ranges::none_of(kDeviceKinds, hasBoth)) return true;
  if (kind != other.kind || *this == other) return false;
  if (kind == Kind::kPosture || kind == Kind::kPinch) return true;
  const auto axis = kind == Kind::kButton ? axisOf(button) : std::nullopt;
  return axis && axis == axisOf(other.button);
}

std::uint32_t pushedAxes(const BallSample& ball, std::uint32_t before) noexcept {
  constexpr float kBegins = 0.5F, kEnds = 0.33F;
  std::uint32_t pushed = 0;
  for (unsigned i = 0; i < 6; ++i) {
    const float share = i < 3 ? ball.translation[i] : ball.rotation[i - 3];
    for (const unsigned negative : {0U, 1U}) {
      const std::uint32_t bit = 1U << (kMostButtons + 2 * i + negative);
      const float push = negative == 1 ? -share : share;
      if (push > ((before & bit) != 0 ? kEnds : kBegins)) pushed |= bit;
    }
  }
  return pushed;
}

std::optional<Input> parseInput(std::string_view name) {
  if (name == "panel.button") return Input{Input::Kind::kPanelButton, {}, 0, {}};
  if (auto input = button(name)) return input;
  if (auto input = namedButton(name)) return input;
  if (auto input = key(name)) return input;
  if (auto input = axis(name)) return input;
  if (auto input = posture(name)) return input;
  if (auto input = gesture(name)) return input;
  if (auto input = pinch(name)) return input;  // after the postures, since "posture.pinch" is one
  return wristSwitch(name);
}

}  // namespace merlin::actions
