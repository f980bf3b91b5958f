// TouchMotion: the common motion of the fingers on a touch surface. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/port/samples.h"

namespace merlin::render::scene {

// Motion of the fingers, or of a mouse wheel, since the last frame. It may be a drag, a pinch and a
// turn at the same time.
struct TouchMotion {
  std::uint32_t fingers = 0;  // number of fingers that touch now
  // Motion of the fingers' centre, in heights of the surface.
  float right = 0, up = 0;
  float spread = 0;    // natural logarithm of the ratio by which they moved apart; < 0: together
  float turn_rad = 0;  // rotation about their centre, counter-clockwise as the person sees it

  bool moves() const { return right != 0 || up != 0 || spread != 0 || turn_rad != 0; }
};

// Computes TouchMotion from one sample to the next, using only the fingers that are in both
// samples: a finger that appears or disappears moves nothing. A notch of the mouse wheel away from
// the person adds kPerNotch to `spread`. Thread-bound.
class TouchFollower {
 public:
  // Returns the motion since the last call. `touch`: the newest sample; null: the device does not
  // work, which counts as no finger.
  TouchMotion update(const TouchSample* touch);

  static constexpr float kPerNotch = 0.1F;  // TouchMotion::spread

 private:
  TouchSample last_{};
  bool known_ = false;  // last_ holds a valid count of the wheel's notches
};

}  // namespace merlin::render::scene
