#include "daemon/actions/pinch.h"

#include <algorithm>
#include <cmath>

namespace merlin::actions {
namespace {

// Smallest distance that is distinguished, in heights of the surface; smaller ones count as this
// one.
constexpr float kTooClose = 0.01F;

// Returns the root mean square distance of the fingers from their centre, in heights of the
// surface. `fingers`: number of fingers. REQUIRES: fingers > 0.
float distanceOf(const TouchSample& touch, std::uint32_t fingers) noexcept {
  const auto count = static_cast<float>(fingers);
  float x = 0, y = 0;
  for (std::uint32_t i = 0; i < fingers; ++i) {
    x += touch.position[i][0] * touch.aspect / count;
    y += touch.position[i][1] / count;
  }
  float square = 0;
  for (std::uint32_t i = 0; i < fingers; ++i) {
    const float dx = touch.position[i][0] * touch.aspect - x, dy = touch.position[i][1] - y;
    square += (dx * dx + dy * dy) / count;
  }
  return std::max(std::sqrt(square), kTooClose);
}

}  // namespace

std::uint32_t Pinch::update(const TouchSample& touch) noexcept {
  const std::uint32_t fingers = std::min<std::uint32_t>(touch.fingers, kFingers);
  std::array<std::uint32_t, kFingers> id{};
  std::copy_n(std::begin(touch.id), fingers, id.begin());
  std::sort(id.begin(), id.begin() + fingers);
  const bool same = fingers == fingers_ && id == id_;
  id_ = id;
  fingers_ = fingers;
  if (fingers < 2) return pinched_ = 0;
  const float distance = distanceOf(touch, fingers);
  if (!same) {
    began_ = distance;
    return pinched_ = 0;
  }
  const auto beyond = [&](std::uint32_t bit, float ratio) {
    return ratio > ((pinched_ & bit) != 0 ? kEnds : kBegins) ? bit : 0U;
  };
  return pinched_ = beyond(kTogether, began_ / distance) | beyond(kApart, distance / began_);
}

}  // namespace merlin::actions
