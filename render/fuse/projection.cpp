#include "render/fuse/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace merlin::render::fuse {

using range::Scanner;

Projection::Projection(const range::RangeImage& image)
    : scanner_(image.geometry.scanner),
      width_(static_cast<double>(image.width)),
      height_(static_cast<double>(image.height)),
      wraps_(image.wraps()) {
  const range::Geometry& g = image.geometry;
  if (scanner_ == Scanner::kOrthogonal) {
    per_column_ = (width_ - 1) / g.horizontal_rad;
    per_row_ = (height_ - 1) / g.vertical_rad;
  } else if (scanner_ == Scanner::kPinhole) {
    per_column_ = width_ / (2 * std::tan(g.horizontal_rad / 2));
    per_row_ = height_ / (2 * std::tan(g.vertical_rad / 2));
  } else {
    per_column_ = width_ / g.horizontal_rad;
    beams_ = g.beams;
  }
}

std::optional<Place> Projection::inside(double column, double row) const {
  // Allows for rounding: a point on the first or last row or column belongs to the adjacent cell.
  constexpr double kRounding = 1e-9;
  if (!(row >= -kRounding) || !(row <= height_ - 1 + kRounding)) return std::nullopt;
  if (wraps_) {
    column -= width_ * std::floor(column / width_);
    column = column < width_ ? column : 0;
  } else if (!(column >= -kRounding) || !(column <= width_ - 1 + kRounding)) {
    return std::nullopt;
  }
  return Place{std::max(column, 0.0), std::max(row, 0.0)};
}

std::optional<Place> Projection::onSpinning(const Point& p) const {
  const double altitude = std::atan2(p[1], std::hypot(p[0], p[2]));
  const auto below = std::upper_bound(
      beams_.begin(), beams_.end(), altitude,
      [](double angle, const range::Beam& beam) { return angle > beam.altitude_rad; });
  if (below == beams_.begin() || below == beams_.end()) return std::nullopt;
  const range::Beam &a = *(below - 1), &b = *below;
  const double share = (a.altitude_rad - altitude) / (a.altitude_rad - b.altitude_rad);
  const double row = static_cast<double>(below - beams_.begin()) - 1 + share;
  const double offset = a.azimuth_rad + share * (b.azimuth_rad - a.azimuth_rad);
  constexpr double kTurn = 2 * std::numbers::pi;
  const double azimuth = std::remainder(std::atan2(p[0], -p[2]) - offset, kTurn);
  return inside(azimuth * per_column_ + (width_ - 1) / 2, row);
}

std::optional<Place> Projection::at(const Point& p) const {
  if (scanner_ == Scanner::kSpinning) return onSpinning(p);
  if (!(p[2] < 0)) return std::nullopt;
  double x = p[0] / -p[2], y = p[1] / -p[2];
  if (scanner_ == Scanner::kOrthogonal) x = std::atan(x), y = std::atan(y);
  return inside(x * per_column_ + (width_ - 1) / 2, (height_ - 1) / 2 - y * per_row_);
}

std::string inverseFaultOf(const range::RangeImage& image) {
  const range::Geometry& g = image.geometry;
  if (g.scanner == Scanner::kElevation)
    return "is an elevation map; only orthogonal, spinning and pinhole scans can be fused";
  if (g.scanner == Scanner::kRays)
    return "has points with a ray each; only orthogonal, spinning and pinhole scans can be fused";
  if (g.scanner != Scanner::kSpinning) return {};
  for (std::size_t r = 1; r < g.beams.size(); ++r) {
    if (!(g.beams[r].altitude_rad < g.beams[r - 1].altitude_rad))
      return fmt::format(
          "row {} of its table of angles is not below the row before it; only "
          "spinning scans whose rows go from the top to the bottom can be fused",
          r + 1);
  }
  return {};
}

}  // namespace merlin::render::fuse
