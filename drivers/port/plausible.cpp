#include "drivers/port/plausible.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace merlin {
namespace {

// Largest accepted joint angle: far above what the default calibration can give (6 rad).
constexpr float kWidest_rad = 1000;
// Largest accepted speed of a hand [m/s, rad/s]. The smoothed speed reaches it after a jump across
// the whole range within one record.
constexpr float kFastest = 100'000;
constexpr std::uint32_t kButtons = 12, kGloveFlags = 7;

// Whether all values are within -limit..limit; false if one is NaN.
bool within(std::span<const float> values, float limit) noexcept {
  return std::all_of(values.begin(), values.end(), [&](float v) { return std::abs(v) <= limit; });
}

bool isRotation(const float (&q)[4]) noexcept {
  const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return square >= 0.98F * 0.98F && square <= 1.02F * 1.02F;
}

bool isErrorLetter(char c) noexcept {
  return c == ' ' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

bool plausible(const GloveSample& s) noexcept {
  return within(s.angle_rad, kWidest_rad) && s.flags <= kGloveFlags && s.sensors <= kGloveSlots;
}

bool plausible(const TrackerSample& s) noexcept {
  return s.station >= 1 && s.station <= kStations && within(s.position_m, kFurthest_m) &&
         isRotation(s.orientation_wxyz) && isErrorLetter(s.error) && s.stylus <= 1;
}

bool plausible(const BallSample& s) noexcept {
  return within(s.translation, 1) && within(s.rotation, 1) && s.buttons >> kButtons == 0;
}

bool plausible(const TouchSample& s) noexcept {
  constexpr float kWidest = 100;
  if (s.fingers > kFingers || !(s.aspect > 1 / kWidest && s.aspect < kWidest)) return false;
  for (std::size_t i = 0; i < s.fingers; ++i) {
    for (const float share : s.position[i]) {
      if (!(share >= 0 && share <= 1)) return false;
    }
  }
  return true;
}

bool plausible(const PostureSample& s) noexcept {
  return within(s.activation, 1) && s.code < 1U << std::size(s.activation) &&
         s.name[sizeof s.name - 1] == '\0';
}

bool plausible(const HandSample& s) noexcept {
  return within(s.joint_rad, kWidest_rad) && within(s.position_m, kFurthest_m) &&
         isRotation(s.orientation_wxyz) && within(s.velocity_m_s, kFastest) &&
         within(s.turn_rad_s, kFastest) && s.delay_s >= 0 && s.delay_s <= 1000;
}

}  // namespace merlin
