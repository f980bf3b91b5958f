// Pinch: whether the fingers on a touch surface have moved together or apart. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/port/samples.h"

namespace merlin::actions {

// Compares how far the fingers are from their middle with how far they were when the last of them
// came; a finger that comes or goes ends a pinch. Thread-bound; allocates nothing.
class Pinch {
 public:
  // Bits of update(): the fingers are closer together, or farther apart, than by kBegins. Either
  // lasts until they are within kEnds again, so that fingers that tremble there begin nothing
  // twice.
  static constexpr std::uint32_t kTogether = 1, kApart = 2;
  // Ratios of the distances.
  static constexpr float kBegins = 1.4F, kEnds = 1.25F;

  std::uint32_t update(const TouchSample& touch) noexcept;

 private:
  std::array<std::uint32_t, kFingers> id_{};  // of the fingers that touch, ascending
  std::uint32_t fingers_ = 0;
  float began_ = 0;  // their distance from their middle when they came, in heights
  std::uint32_t pinched_ = 0;
};

}  // namespace merlin::actions
