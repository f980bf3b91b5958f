#include "render/scene/touch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace merlin::render::scene {
namespace {

// If two fingers are closer than this, in heights of the surface, the direction between them is too
// uncertain to be used.
constexpr float kTooClose = 0.01F;

// A finger in two samples, in heights of the surface, x to the right and y up.
struct Moved {
  Eigen::Vector2f before, now;
};

Eigen::Vector2f placeOf(const TouchSample& touch, std::size_t i) {
  return {touch.position[i][0] * touch.aspect, 1 - touch.position[i][1]};
}

std::size_t count(const TouchSample& touch) {
  return std::min<std::size_t>(touch.fingers, kFingers);
}

std::vector<Moved> fingersInBoth(const TouchSample& before, const TouchSample& now) {
  std::vector<Moved> both;
  for (std::size_t i = 0; i < count(now); ++i) {
    for (std::size_t k = 0; k < count(before); ++k) {
      if (before.id[k] == now.id[i]) both.push_back({placeOf(before, k), placeOf(now, i)});
    }
  }
  return both;
}

// Adds the turn and the spread of the fingers to `motion`: rotation and scale of the similarity
// transform about the fingers' centre that fits best, from the sums of the dot and cross products
// of the fingers' arms (least squares). The spread of a mouse wheel is kept.
void addTurn(const std::vector<Moved>& fingers, const Moved& middle, TouchMotion& motion) {
  float dot = 0, cross = 0, length = 0, length_now = 0;
  for (const Moved& f : fingers) {
    const Eigen::Vector2f a = f.before - middle.before, b = f.now - middle.now;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
    length += a.squaredNorm();
    length_now += b.squaredNorm();
  }
  const float least = kTooClose * kTooClose;
  if (length < least || length_now < least) return;
  motion.turn_rad = std::atan2(cross, dot);
  motion.spread += std::log(length_now / length) / 2;
}

}  // namespace

TouchMotion TouchFollower::update(const TouchSample* touch) {
  const TouchSample none{};
  const TouchSample& now = touch ? *touch : none;
  TouchMotion motion;
  motion.fingers = static_cast<std::uint32_t>(count(now));
  const std::vector<Moved> fingers = fingersInBoth(last_, now);
  const auto notches = static_cast<std::int16_t>(now.wheel - last_.wheel);
  if (touch && known_) motion.spread = kPerNotch * notches;
  known_ = touch;
  last_ = now;
  if (fingers.empty()) return motion;
  Moved middle{Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()};
  for (const Moved& f : fingers) {
    middle.before += f.before / static_cast<float>(fingers.size());
    middle.now += f.now / static_cast<float>(fingers.size());
  }
  motion.right = middle.now.x() - middle.before.x();
  motion.up = middle.now.y() - middle.before.y();
  if (fingers.size() > 1) addTurn(fingers, middle, motion);
  return motion;
}

}  // namespace merlin::render::scene
