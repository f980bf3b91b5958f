// Strokes: cuts the path of a hand where it moves slowest. A stroke is what lies between two such
// places: a swipe, a whole circle, a twist, and also each part of an ordinary motion. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "nn/gesture/pose.h"

namespace merlin::nn {

// A turn of the hand by 1 rad about the direction in which it points counts as much as this way.
inline constexpr float kRollLever_m = 0.12F;

struct PathPoint {
  std::int64_t at_ns = 0;
  std::array<float, 3> position_m{};  // as in HandPose
  float roll_rad = 0;   // since the follower began: about the hand's own direction, clockwise for
                        // the person whose hand it is
  float speed_m_s = 0;  // of way and turn together: sqrt(v^2 + (kRollLever_m * roll rate)^2)
};

struct StrokeSettings {
  double begins_m_s = 0.25;  // speed from which the hand counts as moving
  double cut_share = 0.30;   // share of the stroke's greatest speed below which it has ended
  double rise_share = 0.15;  // share of it by which the speed has to rise for the next stroke
  double longest_s = 4.0;    // a stroke that takes longer is ignored
};

// Thread-bound. Allocation-free; update() costs the same for each pose.
class StrokeFinder {
 public:
  explicit StrokeFinder(const StrokeSettings& settings = {}) noexcept : settings_(settings) {}

  // Takes the next pose. Returns the stroke that ended with it: valid until the next call; empty
  // for none. A pose that is not finite, or not at least 7 ms later than the last one, is ignored.
  // After more than a quarter of a second without a pose, the finder starts anew.
  std::span<const PathPoint> update(const HandPose& pose) noexcept;

  // Speed before the present or the last stroke began, averaged over about 0.2 s.
  float calmBefore_m_s() const noexcept { return before_m_s_; }
  // The newest point.
  const PathPoint& newest() const noexcept { return newest_; }

 private:
  enum class State : std::uint8_t { kStill, kMoving, kFalling };
  static constexpr std::size_t kMost = 640;  // points: 4 s at most, 7 ms apart

  void restart(const HandPose& pose) noexcept;
  void advance(const HandPose& pose, float dt_s) noexcept;
  std::span<const PathPoint> step() noexcept;
  void begin() noexcept;
  std::span<const PathPoint> finish() noexcept;

  StrokeSettings settings_;
  State state_ = State::kStill;
  bool started_ = false, turned_back_ = false, ended_ = false;
  HandPose last_;
  PathPoint newest_;
  std::array<float, 4> velocity_{};  // of x, y, z and lever * roll, smoothed [m/s]
  float slow_m_s_ = 0;               // speed, averaged over about 0.2 s
  float before_m_s_ = 0;
  float greatest_ = 0, least_ = 0;  // greatest speed of the stroke; least speed since then
  std::size_t count_ = 0;
  std::array<PathPoint, kMost> points_{};
};

}  // namespace merlin::nn
