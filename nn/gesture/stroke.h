// StrokeFinder: cuts the path of a hand into strokes at the points where the hand moves slowest. A
// stroke is, for example, a swipe, a whole circle or a twist, but also each part of an ordinary
// motion. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "nn/gesture/pose.h"

namespace merlin::nn {

// A roll of the hand by 1 rad (about the direction in which it points) counts as much as a
// displacement by this length.
inline constexpr float kRollLever_m = 0.12F;

struct PathPoint {
  std::int64_t at_ns = 0;
  std::array<float, 3> position_m{};  // as in HandPose
  // Roll since the finder last started, about the direction in which the hand points. Positive is
  // clockwise, as seen by the person whose hand it is.
  float roll_rad = 0;
  float speed_m_s = 0;  // translation and roll combined: sqrt(v^2 + (kRollLever_m * roll rate)^2)
};

struct StrokeSettings {
  double begins_m_s = 0.25;  // speed from which the hand counts as moving
  double cut_share = 0.30;   // share of the stroke's greatest speed below which the stroke ends
  // Share of the stroke's greatest speed by which the speed has to rise for the next stroke.
  double rise_share = 0.15;
  double longest_s = 4.0;  // a stroke that takes longer is ignored
};

// Thread-bound. Allocation-free; update() takes constant time, except for the end of a stroke,
// which is linear in the stroke's points.
class StrokeFinder {
 public:
  explicit StrokeFinder(const StrokeSettings& settings = {}) noexcept : settings_(settings) {}

  // Takes the next pose. Returns the stroke that ended with this pose, valid until the next call;
  // empty if none ended. A pose that is not finite, or not at least 7 ms later than the last one,
  // is ignored. After more than 0.25 s without a pose, the finder starts anew.
  std::span<const PathPoint> update(const HandPose& pose) noexcept;

  // Returns the speed just before the stroke began that update() has just returned, averaged over
  // about 0.2 s.
  float calmBefore_m_s() const noexcept { return before_m_s_; }
  // Returns the point of the newest pose that was not ignored.
  const PathPoint& newest() const noexcept { return newest_; }

 private:
  enum class State : std::uint8_t { kStill, kMoving, kFalling };
  static constexpr std::size_t kMost = 640;  // points: enough for 4 s with poses 7 ms apart

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
  std::array<float, 4> velocity_{};  // smoothed rates of x, y, z and lever * roll [m/s]
  float slow_m_s_ = 0;               // speed averaged over about 0.2 s
  float before_m_s_ = 0;
  float greatest_ = 0, least_ = 0;  // greatest speed of the stroke; least speed since its end [m/s]
  std::size_t count_ = 0;
  std::array<PathPoint, kMost> points_{};
};

}  // namespace merlin::nn
