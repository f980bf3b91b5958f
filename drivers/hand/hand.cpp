#include "drivers/hand/hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::hand {
namespace {

constexpr float kLongestGap_s = 0.2F;  // the filter restarts after a longer gap between records
constexpr float kSpeedCutoff_hz = 4;   // low-pass on the velocities
constexpr float kReach_m = 0.3F;       // for the cut-off, 1 rad/s counts as a speed of 0.3 m/s
constexpr std::int64_t kOldestGlove_ns = 500'000'000;
constexpr float kFurthest_s = 0.1F;

using Quaternion = std::array<float, 4>;
using Vector = std::array<float, 3>;

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion load(const float (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }

// Returns the rotation vector from `from` to `to` in the frame's axes [rad], the short way round.
Vector turnBetween(const Quaternion& from, const Quaternion& to) {
  Quaternion d = product(to, {from[0], -from[1], -from[2], -from[3]});
  if (d[0] < 0) {
    for (float& v : d) v = -v;
  }
  const float s = std::sqrt(d[1] * d[1] + d[2] * d[2] + d[3] * d[3]);
  const float angle = 2 * std::atan2(s, d[0]);
  const float scale = s > 1e-9F ? angle / s : 2;
  return {scale * d[1], scale * d[2], scale * d[3]};
}

Quaternion turned(const Quaternion& q, const Vector& turn) {
  const float angle = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  const float scale = angle > 1e-9F ? std::sin(angle / 2) / angle : 0.5F;
  Quaternion r =
      product({std::cos(angle / 2), scale * turn[0], scale * turn[1], scale * turn[2]}, q);
  float norm = 0;
  for (const float v : r) norm += v * v;
  for (float& v : r) v /= std::sqrt(norm);
  return r;
}

float norm(const float (&v)[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// Returns the share of the remaining difference that a first-order low-pass covers within dt.
float share(float cutoff_hz, float dt_s) {
  return 1 - std::exp(-2 * std::numbers::pi_v<float> * cutoff_hz * dt_s);
}

}  // namespace

const std::array<std::string_view, kGloveSlots> kJointNames = {
    "thumb_roll", "thumb_mcp",   "thumb_ip",   "thumb_abduction",
    "index_mcp",  "index_pip",   "index_dip",  "index_abduction",
    "middle_mcp", "middle_pip",  "middle_dip", "middle_index_abduction",
    "ring_mcp",   "ring_pip",    "ring_dip",   "ring_middle_abduction",
    "pinky_mcp",  "pinky_pip",   "pinky_dip",  "pinky_ring_abduction",
    "palm_arch",  "wrist_pitch", "wrist_yaw"};

std::optional<std::size_t> jointNamed(std::string_view name) {
  const auto found = std::find(kJointNames.begin(), kJointNames.end(), name);
  if (found == kJointNames.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kJointNames.begin());
}

HandSample Hand::update(const TrackerSample& tracker, const std::optional<GloveSample>& glove) {
  const float dt_s = static_cast<float>(tracker.received_ns - hand_.received_ns) * 1e-9F;
  if (!started_ || dt_s > kLongestGap_s) {
    start(tracker);
  } else if (dt_s > 0) {
    follow(tracker, dt_s);
  }
  hand_.received_ns = tracker.received_ns;
  hand_.counter = tracker.counter;
  hand_.flags = 0;
  if (glove && tracker.received_ns - glove->received_ns < kOldestGlove_ns) {
    hand_.flags |= HandSample::kJoints;
    hand_.glove_ns = glove->received_ns;
    std::copy(std::begin(glove->angle_rad), std::end(glove->angle_rad), hand_.joint_rad);
  }
  return hand_;
}

void Hand::start(const TrackerSample& tracker) {
  started_ = true;
  std::copy(std::begin(tracker.position_m), std::end(tracker.position_m), hand_.position_m);
  std::copy(std::begin(tracker.orientation_wxyz), std::end(tracker.orientation_wxyz),
            hand_.orientation_wxyz);
  std::fill(std::begin(hand_.velocity_m_s), std::end(hand_.velocity_m_s), 0.0F);
  std::fill(std::begin(hand_.turn_rad_s), std::end(hand_.turn_rad_s), 0.0F);
  hand_.delay_s = 0;
}

// The velocities are those of the smoothed pose: at a constant velocity v the smoothed pose lags by
// v * delay, and moves by v * dt in each step.
void Hand::follow(const TrackerSample& tracker, float dt_s) {
  const Quaternion before = load(hand_.orientation_wxyz);
  const Vector turn = turnBetween(before, load(tracker.orientation_wxyz));
  const float speed = norm(hand_.velocity_m_s) + kReach_m * norm(hand_.turn_rad_s);
  const auto cutoff = static_cast<float>(settings_.cutoff_hz) +
                      static_cast<float>(settings_.cutoff_per_m_s) * speed;
  const bool smooths = settings_.cutoff_hz > 0;
  const float step = smooths ? share(cutoff, dt_s) : 1;
  const float quick = share(kSpeedCutoff_hz, dt_s);
  Vector part{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float moved = step * (tracker.position_m[i] - hand_.position_m[i]);
    hand_.position_m[i] += moved;
    hand_.velocity_m_s[i] += quick * (moved / dt_s - hand_.velocity_m_s[i]);
    part[i] = step * turn[i];
    hand_.turn_rad_s[i] += quick * (part[i] / dt_s - hand_.turn_rad_s[i]);
  }
  const Quaternion after = turned(before, part);
  std::copy(after.begin(), after.end(), hand_.orientation_wxyz);
  hand_.delay_s = smooths ? 1 / (2 * std::numbers::pi_v<float> * cutoff) : 0;
}

Pose poseAt(const HandSample& hand, Timestamp when) {
  const auto ahead_s = static_cast<float>(toSeconds(when - fromNanoseconds(hand.received_ns)));
  // The delay of the smoothing is compensated as well.
  const float t = std::clamp(ahead_s + hand.delay_s, -kFurthest_s, kFurthest_s);
  Pose pose{};
  Vector turn{};
  for (std::size_t i = 0; i < 3; ++i) {
    pose.position_m[i] = hand.position_m[i] + t * hand.velocity_m_s[i];
    turn[i] = t * hand.turn_rad_s[i];
  }
  pose.orientation_wxyz = turned(load(hand.orientation_wxyz), turn);
  return pose;
}

}  // namespace merlin::hand
