#include "nn/gesture/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::nn {
namespace {

constexpr std::size_t kPoints = 24;  // number of points in the resampled path
constexpr float kLeastLength_m = 0.02F, kLeastSpeed_m_s = 0.01F;
constexpr float kFull = 2 * std::numbers::pi_v<float>;

using Point = std::array<float, 4>;  // x, y, z and lever * roll [m]
using Path = std::array<Point, kPoints>;

Point placeOf(const PathPoint& p) noexcept {
  return {p.position_m[0], p.position_m[1], p.position_m[2], kRollLever_m * p.roll_rad};
}

float distance(const Point& a, const Point& b) noexcept {
  float square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square);
}

float lengthOf(std::span<const PathPoint> stroke) noexcept {
  float length = 0;
  for (std::size_t n = 1; n < stroke.size(); ++n)
    length += distance(placeOf(stroke[n - 1]), placeOf(stroke[n]));
  return length;
}

// Returns points at equal distances along the path.
Path resample(std::span<const PathPoint> stroke, float length) noexcept {
  Path path{};
  path[0] = placeOf(stroke.front());
  std::size_t done = 1;
  float passed = 0;
  for (std::size_t n = 1; n < stroke.size() && done < kPoints; ++n) {
    const Point a = placeOf(stroke[n - 1]), b = placeOf(stroke[n]);
    const float step = distance(a, b);
    for (; done < kPoints; ++done) {
      const float at = length * static_cast<float>(done) / static_cast<float>(kPoints - 1);
      if (at > passed + step) break;
      const float share = step > 0 ? (at - passed) / step : 0;
      for (std::size_t i = 0; i < a.size(); ++i) path[done][i] = a[i] + share * (b[i] - a[i]);
    }
    passed += step;
  }
  for (; done < kPoints; ++done) path[done] = placeOf(stroke.back());  // points left by rounding
  return path;
}

// Returns the number of full turns of the path's direction in the wall's plane, positive if
// clockwise as the person sees it. Steps that are short in that plane are skipped, since their
// direction is unreliable.
float turningOf(const Path& path, float length) noexcept {
  const float least = 0.2F * length / static_cast<float>(kPoints - 1);
  float sum = 0, last = 0;
  bool any = false;
  for (std::size_t n = 1; n < kPoints; ++n) {
    const float x = path[n][0] - path[n - 1][0], y = path[n][1] - path[n - 1][1];
    if (std::hypot(x, y) < least) continue;
    const float direction = std::atan2(y, x);
    if (any) sum += std::remainder(last - direction, kFull);
    last = direction;
    any = true;
  }
  return sum / kFull;
}

float areaOf(const Path& path, float length) noexcept {
  float twice = 0;
  for (std::size_t n = 0; n < kPoints; ++n) {
    const Point &a = path[n], &b = path[(n + 1) % kPoints];
    twice += b[0] * a[1] - a[0] * b[1];
  }
  return 2 * std::numbers::pi_v<float> * twice / (length * length);
}

float bendOf(const Path& path) noexcept {
  const Point &a = path.front(), &b = path.back();
  const float chord = distance(a, b);
  float most = 0;
  for (const Point& p : path) {
    float along = 0, square = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      along += (p[i] - a[i]) * (b[i] - a[i]);
      square += (p[i] - a[i]) * (p[i] - a[i]);
    }
    const float on = chord > 0 ? along / chord : 0;
    most = std::max(most, std::sqrt(std::max(0.0F, square - on * on)));
  }
  return most;
}

}  // namespace

std::optional<StrokeFeatures> featuresOf(std::span<const PathPoint> stroke, float calm_m_s,
                                         const UsualPace& pace) noexcept {
  if (stroke.size() < 3) return std::nullopt;
  const float length = lengthOf(stroke);
  const float seconds = static_cast<float>(stroke.back().at_ns - stroke.front().at_ns) * 1e-9F;
  if (!(length > kLeastLength_m) || !(seconds > 0)) return std::nullopt;
  const Path path = resample(stroke, length);
  float greatest = kLeastSpeed_m_s;
  for (const PathPoint& p : stroke) greatest = std::max(greatest, p.speed_m_s);
  const Point &from = path.front(), &to = path.back();
  const StrokeFeatures features{(to[0] - from[0]) / length,
                                (to[1] - from[1]) / length,
                                (to[2] - from[2]) / length,
                                (to[3] - from[3]) / length,
                                turningOf(path, length),
                                areaOf(path, length),
                                bendOf(path) / length,
                                std::log(length),
                                std::log(seconds),
                                std::log(greatest),
                                length / seconds / greatest,
                                calm_m_s / greatest,
                                pace.hasteOf(std::log(length), std::log(greatest))};
  float sum = 0;  // NaN if any feature is not finite
  for (const float f : features) sum += f * 0;
  return sum == 0 ? std::optional(features) : std::nullopt;
}

}  // namespace merlin::nn
