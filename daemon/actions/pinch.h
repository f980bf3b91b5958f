// Pinch: detects that the fingers on a touch surface have moved together or apart. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/port/samples.h"

namespace merlin::actions {

// Compares the distance of the fingers from their centre with the distance at the moment when the
// last finger touched the surface. A finger that touches or leaves the surface ends a pinch.
// Thread-bound; allocates nothing.
class Pinch {
 public:
  // Bits of the result of update(). kTogether or kApart is set when the fingers have become closer
  // together or farther apart by more than the ratio kBegins, and stays set until the ratio falls
  // below kEnds, so that trembling fingers trigger an action only once.
  static constexpr std::uint32_t kTogether = 1, kApart = 2;
  // Ratios of the two distances, the larger one divided by the smaller one.
  static constexpr float kBegins = 1.4F, kEnds = 1.25F;

  std::uint32_t update(const TouchSample& touch) noexcept;

 private:
  std::array<std::uint32_t, kFingers> id_{};  // ids of the fingers that touch, in ascending order
  std::uint32_t fingers_ = 0;
  // Distance of the fingers from their centre when the last one touched, in heights of the surface.
  float began_ = 0;
  std::uint32_t pinched_ = 0;
};

}  // namespace merlin::actions
