// TouchMotion: how the fingers on a touch surface move together. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/port/samples.h"

namespace merlin::render::scene {

// What the fingers, or a mouse's wheel, did since the last frame. A drag, a pinch and a turn happen
// at once.
struct TouchMotion {
  std::uint32_t fingers = 0;  // that touch now
  // The fingers' middle moved, in heights of the surface.
  float right = 0, up = 0;
  float spread = 0;    // natural logarithm of the ratio by which they moved apart; < 0: together
  float turn_rad = 0;  // they turned about their middle, counter-clockwise as the person sees it

  bool moves() const { return right != 0 || up != 0 || spread != 0 || turn_rad != 0; }
};

// Compares each sample with the one before, by the fingers that are in both: a finger that comes or
// goes moves nothing. A notch of a mouse's wheel away from the person spreads by kPerNotch.
// Thread-bound.
class TouchFollower {
 public:
  // `touch`: the newest sample; null: the device does not work, and no finger touches.
  TouchMotion update(const TouchSample* touch);

  static constexpr float kPerNotch = 0.1F;  // TouchMotion::spread

 private:
  TouchSample last_{};
  bool known_ = false;  // the wheel's count is that of last_
};

}  // namespace merlin::render::scene
