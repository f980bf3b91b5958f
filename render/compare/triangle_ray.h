// Ray: where a ray first meets a triangle.
//
// Watertight: a ray that meets the edge that two triangles share meets at least one of them, since
// both see the same edge with the same rounding. [WOOP13]. Reentrant.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "render/compare/vector.h"

namespace merlin::render::compare {

struct RayHit {
  double distance = 0;                  // along the ray, in lengths of its direction; > 0
  std::array<double, 3> barycentric{};  // of the corners a, b, c; each 0..1, their sum is 1
};

class Ray {
 public:
  // REQUIRES: finite numbers, and a direction, of any length, that is not zero.
  Ray(const Vector& origin, const Vector& direction) noexcept;

  // Where the ray meets the triangle, from either side; nothing if it passes beside it, or in its
  // plane, or if the triangle lies behind the origin or has no area.
  std::optional<RayHit> hit(const std::array<Vector, 3>& corners) const noexcept;

  // Where the ray enters the box, as a distance; infinite if it misses it. Rounded so that the box
  // of a triangle that hit() meets is never missed. REQUIRES: low <= high.
  double entry(const std::array<float, 3>& low, const std::array<float, 3>& high) const noexcept;

 private:
  Vector origin_, inverse_;    // inverse: 1 / direction, finite
  std::array<int, 3> axes_{};  // the last one is that along which the ray is longest
  double shear_x_, shear_y_;   // take the direction to that axis
  double scale_;
};

}  // namespace merlin::render::compare
