#include "nn/gesture/stroke.h"

#include <algorithm>
#include <cmath>

namespace merlin::nn {
namespace {

constexpr std::int64_t kNearest_ns = 7'000'000, kLongestGap_ns = 250'000'000;
constexpr float kSmooth_s = 0.025F;  // time constant of the velocity
constexpr float kSlow_s = 0.2F;      // time constant of the speed before a stroke
constexpr float kStillShare = 0.4F;  // share of begins_m_s below which the hand is still

bool isFinite(const HandPose& pose) noexcept {
  float sum = 0;  // NaN if any value is not finite
  for (const float v : pose.position_m) sum += v * 0;
  for (const float v : pose.orientation_wxyz) sum += v * 0;
  return sum == 0;
}

// Returns the rotation [rad] from one orientation to the next about the hand's own -z axis;
// positive is clockwise, as the person sees it.
float rollBetween(const std::array<float, 4>& from, const std::array<float, 4>& to) noexcept {
  // w and z components of the quaternion product conj(from) * to.
  const float w = from[0] * to[0] + from[1] * to[1] + from[2] * to[2] + from[3] * to[3];
  const float z = from[0] * to[3] - from[3] * to[0] - from[1] * to[2] + from[2] * to[1];
  return -2 * std::atan2(w < 0 ? -z : z, std::abs(w));
}

}  // namespace

std::span<const PathPoint> StrokeFinder::update(const HandPose& pose) noexcept {
  if (!isFinite(pose)) return {};
  const std::int64_t gap_ns = pose.at_ns - last_.at_ns;
  if (!started_ || gap_ns > kLongestGap_ns) {
    restart(pose);
    return {};
  }
  if (gap_ns < kNearest_ns) return {};
  advance(pose, static_cast<float>(gap_ns) * 1e-9F);
  return step();
}

void StrokeFinder::restart(const HandPose& pose) noexcept {
  started_ = true;
  last_ = pose;
  state_ = State::kStill;
  velocity_ = {};
  slow_m_s_ = before_m_s_ = 0;
  newest_ = {pose.at_ns, pose.position_m, 0, 0};
  points_[0] = newest_;
  count_ = 1;
}

// Updates the newest point and the smoothed velocities with a pose that is `dt_s` later.
void StrokeFinder::advance(const HandPose& pose, float dt_s) noexcept {
  const float roll = rollBetween(last_.orientation_wxyz, pose.orientation_wxyz);
  const float share = dt_s / (kSmooth_s + dt_s);
  const std::array<float, 4> before = velocity_;
  float along = 0, square = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const float way = i < 3 ? pose.position_m[i] - last_.position_m[i] : kRollLever_m * roll;
    velocity_[i] += share * (way / dt_s - velocity_[i]);
    along += velocity_[i] * before[i];
    square += velocity_[i] * velocity_[i];
  }
  turned_back_ = along < 0;
  if (ended_) {
    points_[0] = newest_;
    count_ = 1;
  }
  ended_ = false;
  newest_ = {pose.at_ns, pose.position_m, newest_.roll_rad + roll, std::sqrt(square)};
  slow_m_s_ += dt_s / (kSlow_s + dt_s) * (newest_.speed_m_s - slow_m_s_);
  last_ = pose;
  if (count_ < kMost) points_[count_++] = newest_;
}

std::span<const PathPoint> StrokeFinder::step() noexcept {
  const float speed = newest_.speed_m_s, begins = static_cast<float>(settings_.begins_m_s);
  switch (state_) {
    case State::kStill:
      if (speed < kStillShare * begins) {
        points_[0] = newest_;
        count_ = 1;
        before_m_s_ = slow_m_s_;
      }
      if (speed >= begins) begin();
      return {};
    case State::kMoving:
      greatest_ = std::max(greatest_, speed);
      if (speed < static_cast<float>(settings_.cut_share) * greatest_ || turned_back_)
        return finish();
      return {};
    case State::kFalling: break;
  }
  if (speed < least_) {  // the next stroke begins at the slowest point
    least_ = speed;
    points_[0] = newest_;
    count_ = 1;
    before_m_s_ = slow_m_s_;
  }
  if (least_ < kStillShare * begins) {
    state_ = State::kStill;
  } else if (speed - least_ > static_cast<float>(settings_.rise_share) * greatest_ &&
             speed >= begins) {
    begin();
  }
  return {};
}

void StrokeFinder::begin() noexcept {
  state_ = State::kMoving;
  greatest_ = newest_.speed_m_s;
}

// Ends the stroke and returns it without its slow beginning; empty if it has too few points or is
// too long.
std::span<const PathPoint> StrokeFinder::finish() noexcept {
  state_ = State::kFalling;
  ended_ = true;
  least_ = newest_.speed_m_s;
  const std::span<const PathPoint> all(points_.data(), count_);
  const float least = static_cast<float>(settings_.cut_share) * greatest_;
  const auto first = std::find_if(all.begin(), all.end(),
                                  [&](const PathPoint& p) { return p.speed_m_s >= least; });
  const std::size_t skipped =
      first == all.begin() ? 0 : static_cast<std::size_t>(first - all.begin()) - 1;
  const std::span<const PathPoint> stroke = all.subspan(skipped);
  const bool fits =
      count_ < kMost && stroke.size() > 3 &&
      static_cast<double>(stroke.back().at_ns - stroke.front().at_ns) <= settings_.longest_s * 1e9;
  return fits ? stroke : std::span<const PathPoint>();
}

}  // namespace merlin::nn
