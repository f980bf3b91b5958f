#include "drivers/evdev/input_device.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include <fmt/format.h>
#include <linux/input-event-codes.h>

#include "drivers/port/axes.h"

namespace merlin::evdev {
namespace {

// Counts of a relative axis at full deflection, as 3Dconnexion's mice send them.
constexpr std::int32_t kRelativeScale = 350;
constexpr std::size_t kMostKeys = 768;  // the kernel's KEY_CNT
constexpr std::size_t kLongestName = 200;

AxisSource plain(int code) { return {code, -1, false}; }
AxisSource reversed(int code) { return {code, -1, true}; }
AxisSource pair(int code, int minus) { return {code, minus, false}; }

std::string lowered(const char* text) {
  std::string name(text);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

std::string textOf(const AxisSource& source) {
  if (source.axis < 0) return "none";
  std::string text(source.reversed ? "-" : "");
  text += axisName(source.axis);
  if (source.minus >= 0) text += fmt::format("-{}", axisName(source.minus));
  return text;
}

}  // namespace

InputDevice::Axis* InputDevice::axis(std::uint16_t code) noexcept {
  return code < axes_.size() ? &axes_[code] : nullptr;
}

bool InputDevice::has(int code) const noexcept {
  return code >= 0 && axes_[static_cast<std::size_t>(code)].there;
}

bool InputDevice::hasKey(std::uint16_t code) const noexcept {
  return std::ranges::any_of(keys_, [&](const Key& key) { return key.code == code; });
}

std::size_t InputDevice::axes() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(axes_, &Axis::there));
}

std::vector<std::string> InputDevice::axisNames() const {
  std::vector<std::string> names;
  for (std::size_t code = 0; code < axes_.size(); ++code) {
    const std::string_view name = axisName(static_cast<int>(code));
    if (axes_[code].there && !name.empty()) names.emplace_back(name);
  }
  return names;
}

std::vector<std::string> InputDevice::keyNames() const {
  std::vector<std::string> names;
  for (const Key& key : keys_) names.push_back(key.name);
  return names;
}

std::vector<AxisReading> InputDevice::readings() const {
  std::vector<AxisReading> all;
  for (std::string& name : axisNames()) {
    const int code = *axisNumber(name);
    all.push_back({std::move(name), centred(code)});
  }
  return all;
}

void InputDevice::describe(const EvdevRecord& r) {
  Axis* const at = axis(r.code);
  const auto key = std::ranges::lower_bound(keys_, r.code, {}, &Key::code);
  const bool known = key != keys_.end() && key->code == r.code;
  switch (r.kind) {
    case EvdevRecord::kName:
      if (name_.size() < kLongestName) name_ += r.text.data();
      break;
    case EvdevRecord::kAxis:
      if (at && r.low < r.high) *at = {true, false, r.value, r.low, r.high, {}};
      break;
    case EvdevRecord::kRelative:
      if (at && r.code <= REL_RZ && !at->there)
        *at = {true, true, 0, -kRelativeScale, kRelativeScale, {}};
      break;
    case EvdevRecord::kKey:
      if (!known && keys_.size() < kMostKeys)
        keys_.insert(key, {r.code, lowered(r.text.data()), false});
      break;
    default: take(r, {});
  }
}

void InputDevice::take(const EvdevRecord& r, Timestamp arrived) noexcept {
  if (r.kind == EvdevRecord::kPressed) {
    const auto key = std::ranges::lower_bound(keys_, r.code, {}, &Key::code);
    if (key != keys_.end() && key->code == r.code) key->pressed = r.value != 0;
  }
  Axis* const at = axis(r.code);
  const bool moves = r.kind == EvdevRecord::kMoved || r.kind == EvdevRecord::kShifted;
  if (!at || !at->there || !moves || at->relative != (r.kind == EvdevRecord::kShifted)) return;
  at->value = r.value;
  at->told = arrived;
}

std::string InputDevice::choose(const EvdevSettings& settings) {
  dead_zone_ = static_cast<float>(settings.dead_zone);
  curve_ = static_cast<float>(settings.curve);
  std::vector<std::string> lacking = chooseAxes(settings.axes);
  for (std::string& key : chooseButtons(settings.buttons)) lacking.push_back(std::move(key));
  if (lacking.empty()) return {};
  return fmt::format("it has no {}, which the configuration names", fmt::join(lacking, ", no "));
}

// Returns the axes that suit the kind of device. In the kernel, positive x is to the right, and
// positive y is down or towards the person; README.md has the table.
AxisSources InputDevice::usualSources() const {
  const bool six =
      has(ABS_X) && has(ABS_Y) && has(ABS_Z) && has(ABS_RX) && has(ABS_RY) && has(ABS_RZ);
  const AxisSource hat_x = reversed(ABS_HAT0X), hat_y = reversed(ABS_HAT0Y);
  if (six && !hasKey(BTN_GAMEPAD) && !hasKey(BTN_JOYSTICK)) {  // a space mouse; its z is down
    return {plain(ABS_X),  reversed(ABS_Z),  plain(ABS_Y),
            plain(ABS_RX), reversed(ABS_RZ), plain(ABS_RY)};
  }
  if (hasKey(BTN_JOYSTICK) && !hasKey(BTN_GAMEPAD) && !has(ABS_RX) && !has(ABS_Z)) {  // a stick
    return {plain(ABS_HAT0X), hat_y, {}, plain(ABS_Y), plain(ABS_X), reversed(ABS_RZ)};
  }
  if (has(ABS_RX) && has(ABS_RY)) {  // a gamepad whose triggers are z and rz
    const bool triggers = has(ABS_Z) && has(ABS_RZ);
    return {plain(ABS_X),  triggers ? pair(ABS_RZ, ABS_Z) : hat_y,
            plain(ABS_Y),  plain(ABS_RY),
            plain(ABS_RX), hat_x};
  }
  const bool pedals = has(ABS_GAS) && has(ABS_BRAKE);  // triggers of a gamepad without rx, ry
  return {plain(ABS_X), pedals ? pair(ABS_GAS, ABS_BRAKE) : hat_y,
          plain(ABS_Y), plain(ABS_RZ),
          plain(ABS_Z), hat_x};
}

// Chooses the axes. Returns the missing ones, as "axis throttle"; the ball's axes that they should
// control stay at rest.
std::vector<std::string> InputDevice::chooseAxes(const std::vector<std::string>& names) {
  std::vector<std::string> lacking;
  sources_ = names.empty() ? usualSources() : AxisSources{};
  for (std::size_t i = 0; i < std::min(names.size(), sources_.size()); ++i)
    sources_[i] = parseAxisSource(names[i], axisNumber).value_or(AxisSource{});
  for (AxisSource& source : sources_) {
    bool whole = true;
    for (const int code : {source.axis, source.minus}) {
      if (code < 0 || has(code)) continue;
      whole = false;
      if (!names.empty()) lacking.push_back(fmt::format("axis {}", axisName(code)));
    }
    if (!whole) source = {};
  }
  return lacking;
}

// Chooses the buttons. Returns the missing keys, as "key \"thumbr\""; the buttons after a missing
// key keep their numbers.
std::vector<std::string> InputDevice::chooseButtons(const std::vector<std::string>& names) {
  buttons_.fill(0);
  if (names.empty()) chooseUsualButtons();
  std::vector<std::string> lacking;
  for (std::size_t i = 0; i < std::min(names.size(), buttons_.size()); ++i) {
    const auto key = std::ranges::find(keys_, names[i], &Key::name);
    if (key == keys_.end())
      lacking.push_back(fmt::format("key \"{}\"", names[i]));
    else
      buttons_[i] = 1 + static_cast<std::size_t>(key - keys_.begin());
  }
  return lacking;
}

void InputDevice::chooseUsualButtons() {
  const bool has_buttons =
      std::ranges::any_of(keys_, [](const Key& key) { return key.code >= BTN_MISC; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < keys_.size() && count < buttons_.size(); ++i) {
    if (!has_buttons || keys_[i].code >= BTN_MISC) buttons_[count++] = 1 + i;
  }
}

float InputDevice::centred(int code) const noexcept { return 2 * oneSided(code) - 1; }

float InputDevice::oneSided(int code) const noexcept {
  const Axis& axis = axes_[static_cast<std::size_t>(code)];
  const double range =
      static_cast<double>(axis.high) - axis.low;  // the difference may exceed an int
  const double share = (static_cast<double>(axis.value) - axis.low) / range;
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

float InputDevice::deflection(const AxisSource& source) const noexcept {
  if (!has(source.axis)) return 0;
  if (has(source.minus)) return oneSided(source.axis) - oneSided(source.minus);
  return source.reversed ? -centred(source.axis) : centred(source.axis);
}

void InputDevice::fill(BallSample& sample) const noexcept {
  std::array<float, 6> deflections{};
  std::ranges::transform(sources_, deflections.begin(),
                         [&](const AxisSource& source) { return deflection(source); });
  fillAxes(deflections, dead_zone_, curve_, sample);
  sample.buttons = 0;
  for (std::size_t i = 0; i < buttons_.size(); ++i) {
    if (buttons_[i] > 0 && keys_[buttons_[i] - 1].pressed) sample.buttons |= 1U << i;
  }
  std::size_t pressed = 0;
  for (const Key& key : keys_) {
    if (key.pressed && pressed < kKeys) sample.keys[pressed++] = key.code;
  }
  std::fill(sample.keys + pressed, std::end(sample.keys), std::uint16_t{0});
}

bool InputDevice::restRelative(Timestamp since) noexcept {
  bool moved = false;
  for (Axis& axis : axes_) {
    if (!axis.relative || axis.value == 0 || axis.told > since) continue;
    axis.value = 0;
    moved = true;
  }
  return moved;
}

std::string InputDevice::chosen() const {
  std::vector<std::string> axes, buttons;
  for (const AxisSource& source : sources_) axes.push_back(textOf(source));
  for (const std::size_t button : buttons_) {
    if (button > 0) buttons.push_back(keys_[button - 1].name);
  }
  return fmt::format("axes {}; buttons {}", fmt::join(axes, ", "),
                     buttons.empty() ? "none" : fmt::format("{}", fmt::join(buttons, ", ")));
}

}  // namespace merlin::evdev
