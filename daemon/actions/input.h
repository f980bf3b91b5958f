// Input: a button, key, pinch, posture, gesture or switch that a binding names.
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
  std::string name;                // of the device or the hand
  std::optional<SampleKind> kind;  // of the device; none: a hand, or the panel
  bool hand = false;
  // The kernel's number of a key by its name, "key_space" or "btn_south"; null: it has no keys.
  std::optional<std::uint16_t> (*key_code)(std::string_view) = nullptr;
};

struct Input {
  enum class Kind { kButton, kPosture, kWristSwitch, kPanelButton, kGesture, kKey, kPinch };

  Kind kind = Kind::kButton;
  // The device or the hand whose input it is; empty: any one that has such an input.
  std::string device;
  // kButton: its bit in BallSample::buttons; of an axis that is pushed: a bit of pushedAxes().
  // kKey: the kernel's number, 0 until Source::key_code() gave it. kPinch: a bit of
  // Pinch::update().
  std::uint32_t button = 0;
  std::string name;  // kPosture, kGesture: its name; kKey: "key_space", "btn_south"

  bool isOf(const Source& source) const;
  // Whether it is over as soon as it begins, so that nothing can last or be timed with it.
  bool isMomentary() const { return kind == Kind::kPanelButton || kind == Kind::kGesture; }
  // Whether one event can be both inputs, i.e. they are the same part of the same device.
  bool overlaps(const Input& other) const;
  // Whether a device never has both at a time: an axis is pushed one way, a hand has one posture,
  // fingers move together or apart, and a device has inputs of some kinds only.
  bool rulesOut(const Input& other) const;
  bool operator==(const Input&) const = default;
};

// The axes of a ball that are pushed or twisted by more than half, as bits above those of the
// buttons: x+ x- y+ y- z+ z- rx+ ... rz-. An axis that was among `before` stays until it falls
// below a third, so that an axis that trembles around the threshold triggers nothing twice.
std::uint32_t pushedAxes(const BallSample& ball, std::uint32_t before) noexcept;

// Parses the name of an input (kInputForms); nothing if the name is not valid.
std::optional<Input> parseInput(std::string_view name);

}  // namespace merlin::actions
