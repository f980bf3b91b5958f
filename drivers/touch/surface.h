// Surface: keeps the fingers on an input device of the kernel, which is a multi-touch device with
// slots, a device with a single position, or a mouse, whose pressed button counts as a finger.
// Pure.
//
// Source: Linux Documentation/input/multi-touch-protocol.rst (protocol B), event-codes.rst.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/port/evdev_line.h"
#include "drivers/port/touch_frames.h"
#include "drivers/touch/settings.h"

namespace merlin::touch {

class Surface {
 public:
  enum class Kind { kNone, kSlots, kSingle, kMouse };

  // Takes one record of the description, or of the state that follows it.
  void describe(const EvdevRecord& record);
  // Determines the kind of device; to be called once the description is complete. kNone: the device
  // has neither slots with positions, nor a position with a touch button, nor motion with a button.
  Kind choose(const TouchSettings& settings) noexcept;

  // Takes one record of an event. Allocates nothing.
  void take(const EvdevRecord& record) noexcept;
  // Adds the fingers that touch now, and a mouse's buttons and the notches of its wheel since the
  // last call, to a frame that has begun.
  void fill(TouchFrames& frames) noexcept;

  const std::string& name() const noexcept { return name_; }
  Kind kind() const noexcept { return kind_; }
  std::size_t slots() const noexcept {
    return slots_used_;
  }  // number of the device's slots that are followed
  // Returns the surface's width divided by its height, as a person sees it.
  float aspect() const noexcept { return aspect_; }
  // Returns whether the device reports fingers by the kernel's protocol A, which has no slots.
  bool hasOldProtocol() const noexcept { return !slot_range_ && mt_x_.there; }

  static constexpr std::size_t kSlots = 32;  // further slots are ignored

 private:
  struct Axis {
    bool there = false;
    std::int32_t value = 0, low = 0, high = 0, resolution = 0;
    float share(std::int32_t at) const noexcept;
    double length() const noexcept { return static_cast<double>(high) - low; }
  };
  struct Slot {
    bool down = false, palm = false;
    std::uint32_t id = 0;
    std::int32_t tracking = -1, x = 0, y = 0;
  };

  void describeAxis(const EvdevRecord& record) noexcept;
  void describeKey(std::uint16_t code) noexcept;
  float aspectOf(const TouchSettings& settings) const noexcept;
  void moveSlot(const EvdevRecord& record) noexcept;
  void shiftMouse(const EvdevRecord& record) noexcept;
  void press(const EvdevRecord& record) noexcept;
  void setDown(bool down) noexcept;

  std::string name_;
  Kind kind_ = Kind::kNone;
  float aspect_ = kUsualAspect;
  std::uint32_t last_id_ = 0;

  Axis mt_x_, mt_y_, x_, y_;
  std::optional<std::int32_t> slot_range_;  // highest slot number
  std::array<Slot, kSlots> slots_{};
  std::size_t slots_used_ = 0;
  std::int32_t slot_ = 0;  // slot to which the next records belong

  bool moves_x_ = false, moves_y_ = false;     // the device has the relative axis
  bool has_touch_ = false, has_left_ = false;  // the device has the button
  bool pressed_touch_ = false, pressed_left_ = false, down_ = false;
  std::uint32_t id_ = 0;             // id of the only finger, while down_
  float count_x_ = 0, count_y_ = 0;  // a mouse's count as a share of the sides
  std::array<float, 2> place_{};     // place of a mouse's finger
  std::uint16_t buttons_ = 0;        // as in TouchSample, without the left one
  int notches_ = 0;                  // notches of the wheel since the last fill()
};

}  // namespace merlin::touch
