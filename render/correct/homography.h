// Homography: projective mapping of a plane, as for a keystone correction (corner pin); here of the
// unit square onto four corners.
#pragma once

#include <array>
#include <optional>

namespace merlin::render::correct {

struct Point {
  double x = 0, y = 0;
};

class Homography {
 public:
  // Maps (0, 0), (1, 0), (0, 1) and (1, 1) to these corners, in this order. REQUIRES: they are the
  // corners of a convex quadrilateral that is not mirrored.
  explicit Homography(const std::array<Point, 4>& corners);

  // map() goes from the unit square to the quadrilateral, unmap() back. Both return nothing if the
  // point is on or beyond the line that maps to infinity.
  std::optional<Point> map(Point p) const noexcept { return apply(forward_, p); }
  std::optional<Point> unmap(Point p) const noexcept { return apply(inverse_, p); }

 private:
  using Matrix = std::array<double, 9>;
  static std::optional<Point> apply(const Matrix& m, Point p) noexcept;

  Matrix forward_{}, inverse_{};
};

}  // namespace merlin::render::correct
