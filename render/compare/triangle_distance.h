// Finds the point of a triangle that is nearest to a given point: exact but for rounding, in
// double.
//
// [ERICSON05] 5.1.5, arranged so that a sliver costs no accuracy. Reentrant.
#pragma once

#include <array>

#include "render/compare/vector.h"

namespace merlin::render::compare {

struct NearestPoint {
  double distance2 = 0;                 // squared, model units
  std::array<double, 3> barycentric{};  // of the corners a, b, c; each 0..1, their sum is 1
};

// A triangle without area is treated as its longest edge, one without extent as a point. Rounding
// error: 1e-15 of the distance; 1e-8 of the triangle's size if it is 100,000 times as long as high.
NearestPoint nearestOnTriangle(const Vector& p, const std::array<Vector, 3>& corners) noexcept;

}  // namespace merlin::render::compare
