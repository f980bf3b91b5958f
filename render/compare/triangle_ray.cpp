#include "render/compare/triangle_ray.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace merlin::render::compare {

Ray::Ray(const Vector& origin, const Vector& direction) noexcept : origin_(origin) {
  int longest = 0;
  for (const int k : {1, 2}) {
    if (std::abs(direction[k]) > std::abs(direction[longest])) longest = k;
  }
  assert(direction[longest] != 0);
  axes_ = {(longest + 1) % 3, (longest + 2) % 3, longest};
  if (direction[longest] < 0) std::swap(axes_[0], axes_[1]);  // keeps the sense of rotation
  shear_x_ = direction[axes_[0]] / direction[longest];
  shear_y_ = direction[axes_[1]] / direction[longest];
  scale_ = 1 / direction[longest];
  for (int k = 0; k < 3; ++k) {  // keeps the inverse finite, since 0 x infinity is NaN
    constexpr double kLeast = 1e-300;
    const double least = std::copysign(kLeast, direction[k]);
    inverse_[k] = 1 / (std::abs(direction[k]) < kLeast ? least : direction[k]);
  }
}

std::optional<RayHit> Ray::hit(const std::array<Vector, 3>& corners) const noexcept {
  // Converts the corners to coordinates in which the ray is the positive z axis.
  double x[3], y[3], z[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector from = corners[i] - origin_;
    const double along = from[axes_[2]];
    x[i] = from[axes_[0]] - shear_x_ * along;
    y[i] = from[axes_[1]] - shear_y_ * along;
    z[i] = scale_ * along;
  }
  const double u = x[2] * y[1] - y[2] * x[1];
  const double v = x[0] * y[2] - y[0] * x[2];
  const double w = x[1] * y[0] - y[1] * x[0];
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double area = u + v + w;
  if (area == 0) return std::nullopt;
  const RayHit found{(u * z[0] + v * z[1] + w * z[2]) / area, {u / area, v / area, w / area}};
  if (!(found.distance > 0)) return std::nullopt;
  return found;
}

double Ray::entry(const std::array<float, 3>& low,
                  const std::array<float, 3>& high) const noexcept {
  constexpr double kRounding = 1e-15;  // the relative error of each product is at most 4e-16
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double enter = 0, leave = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double a = (double{low[i]} - origin_[k]) * inverse_[k];
    const double b = (double{high[i]} - origin_[k]) * inverse_[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave * (1 + kRounding) ? enter * (1 - kRounding) : kInfinity;
}

}  // namespace merlin::render::compare
