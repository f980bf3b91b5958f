#include "render/correct/homography.h"

namespace merlin::render::correct {
namespace {

constexpr double kHorizon = 1e-9;  // smallest w; points with a smaller w are not mapped

}  // namespace

// The matrix has the third row (g, h, 1). Eliminating the other elements from the equations of the
// four corners leaves two equations for g and h, which Cramer's rule solves; the others follow. P.
// S. Heckbert, "Fundamentals of texture mapping and image warping", 1989, section 2.2.3.
Homography::Homography(const std::array<Point, 4>& corners) {
  const auto& [p00, p10, p01, p11] = corners;
  const double sx = p00.x - p10.x + p11.x - p01.x, sy = p00.y - p10.y + p11.y - p01.y;
  const double ax = p10.x - p11.x, ay = p10.y - p11.y;
  const double bx = p01.x - p11.x, by = p01.y - p11.y;
  const double det = ax * by - bx * ay;
  const double g = (sx * by - bx * sy) / det, h = (ax * sy - sx * ay) / det;
  forward_ = {p10.x - p00.x + g * p10.x,
              p01.x - p00.x + h * p01.x,
              p00.x,
              p10.y - p00.y + g * p10.y,
              p01.y - p00.y + h * p01.y,
              p00.y,
              g,
              h,
              1};
  const auto& [a, b, c, d, e, f, m, n, i] = forward_;
  inverse_ = {e * i - f * n, c * n - b * i, b * f - c * e, f * m - d * i, a * i - c * m,
              c * d - a * f, d * n - e * m, b * m - a * n, a * e - b * d};
  // Divide the adjugate by the determinant: the inverse's w is then 1 / w of the forward mapping,
  // so it is positive where the forward w is.
  const double whole = a * inverse_[0] + b * inverse_[3] + c * inverse_[6];
  for (double& x : inverse_) x /= whole;
}

std::optional<Point> Homography::apply(const Matrix& m, Point p) noexcept {
  const double w = m[6] * p.x + m[7] * p.y + m[8];
  if (!(w > kHorizon)) return std::nullopt;
  return Point{(m[0] * p.x + m[1] * p.y + m[2]) / w, (m[3] * p.x + m[4] * p.y + m[5]) / w};
}

}  // namespace merlin::render::correct
