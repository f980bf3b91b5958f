// Input: a button, axis, key, pinch, posture, gesture or switch to which an action can be bound.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/port/samples.h"

namespace merlin::actions {

// A source of inputs that trigger actions: a device, a hand (which makes gestures), or the control
// panel.
struct Source {
  std::string name;                // name of the device or the hand
  std::optional<SampleKind> kind;  // kind of the device; nothing: a hand, or the panel
  bool hand = false;
  // Returns the kernel's number of the key with this name, such as "key_space" or "btn_south"; null
  // if the source has no keys.
  std::optional<std::uint16_t> (*key_code)(std::string_view) = nullptr;
};

struct Input {
  enum class Kind { kButton, kPosture, kWristSwitch, kPanelButton, kGesture, kKey, kPinch };

  Kind kind = Kind::kButton;
  // Name of the device or the hand; empty: any one that has such an input.
  std::string device;
  // kButton: a mask with one bit of BallSample::buttons, or, for the push of an axis, of
  // pushedAxes(). kKey: the kernel's number of the key, 0 until it was set from Source::key_code().
  // kPinch: Pinch::kTogether or Pinch::kApart. 0 for other kinds.
  std::uint32_t button = 0;
  std::string name;  // name of the posture, gesture or key ("key_space"); else empty

  bool isOf(const Source& source) const;
  // Whether the input ends as soon as it begins, so that it cannot be held or timed.
  bool isMomentary() const { return kind == Kind::kPanelButton || kind == Kind::kGesture; }
  // Whether one event can be both inputs, i.e. whether both may be the same button, posture etc. of
  // the same device. An input without a device may be one of any device.
  bool overlaps(const Input& other) const;
  // Whether both inputs can never be held at the same time on one device: an axis is pushed in one
  // direction only, a hand has only one posture, fingers move either together or apart, and no kind
  // of device has both kinds of inputs.
  bool rulesOut(const Input& other) const;
  bool operator==(const Input&) const = default;
};

// Returns a mask of the directions in which a ball is pushed or twisted by more than half of full
// scale. The bits follow those of the 12 buttons: x+ x- y+ y- z+ z- rx+ ... rz-. A direction that
// is set in `before`, the previous result, stays set until the push falls below a third, so that a
// push that varies around the threshold triggers an action only once.
std::uint32_t pushedAxes(const BallSample& ball, std::uint32_t before) noexcept;

// Parses the name of an input, which has one of the forms in kInputForms; nothing if the name is
// not valid.
std::optional<Input> parseInput(std::string_view name);

}  // namespace merlin::actions
