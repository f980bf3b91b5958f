// Ray: finds where a ray meets a triangle.
//
// The test is watertight: a ray that meets the common edge of two triangles meets at least one of
// them, since the edge is computed with the same rounding for both ([WOOP13]). Reentrant.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "render/compare/vector.h"

namespace merlin::render::compare {

struct RayHit {
  double distance = 0;                  // distance along the ray, in lengths of its direction; > 0
  std::array<double, 3> barycentric{};  // weights of the corners; each 0..1, their sum is 1
};

class Ray {
 public:
  // Makes a ray; `direction` may have any length. REQUIRES: all numbers are finite, and the
  // direction is not zero.
  Ray(const Vector& origin, const Vector& direction) noexcept;

  // Returns the point where the ray meets the triangle, from either side. Returns nothing if the
  // ray misses the triangle or lies in its plane, or if the triangle is behind the origin or has no
  // area.
  std::optional<RayHit> hit(const std::array<Vector, 3>& corners) const noexcept;

  // Returns the distance at which the ray enters the box, in lengths of its direction; 0 if the
  // origin is inside, infinite if the ray misses the box. The result is rounded so that the box of
  // a triangle for which hit() finds a point is never missed. REQUIRES: low <= high.
  double entry(const std::array<float, 3>& low, const std::array<float, 3>& high) const noexcept;

 private:
  Vector origin_, inverse_;    // inverse: 1 / direction, finite
  std::array<int, 3> axes_{};  // the last one is the axis along which the ray is longest
  double shear_x_, shear_y_;   // shear that maps the direction to that axis
  double scale_;
};

}  // namespace merlin::render::compare
