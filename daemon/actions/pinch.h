// Pinch: whether the fingers on a touch surface have moved together or apart. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/port/samples.h"

namespace merlin::actions {

// Compares the fingers' distance from their centre with that at the time when the last finger
// touched; a finger that touches or leaves the surface ends a pinch. Thread-bound; allocates
// nothing.
class Pinch {
 public:
  // Bits of update(): the fingers are closer together, or farther apart, by more than the ratio
  // kBegins. Either lasts until the ratio is within kEnds again, so that trembling fingers trigger
  // nothing twice.
  static constexpr std::uint32_t kTogether = 1, kApart = 2;
  // Ratios of the distances.
  static constexpr float kBegins = 1.4F, kEnds = 1.25F;

  std::uint32_t update(const TouchSample& touch) noexcept;

 private:
  std::array<std::uint32_t, kFingers> id_{};  // of the fingers that touch, ascending
  std::uint32_t fingers_ = 0;
  // Distance from their centre when the last one touched, in heights of the surface.
  float began_ = 0;
  std::uint32_t pinched_ = 0;
};

}  // namespace merlin::actions
