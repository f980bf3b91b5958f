// Finds the point of a triangle that is nearest to a given point; exact except for rounding, in
// double.
//
// The method is that of [ERICSON05] 5.1.5, arranged so that slivers do not reduce the accuracy.
// Reentrant.
#pragma once

#include <array>

#include "render/compare/vector.h"

namespace merlin::render::compare {

struct NearestPoint {
  double distance2 = 0;                 // squared distance [model units^2]
  std::array<double, 3> barycentric{};  // weights of the corners; each 0..1, their sum is 1
};

// Returns the point of the triangle nearest to p. A triangle without area is treated as its longest
// edge, a triangle without extent as a point. Rounding error: 1e-15 of the distance; 1e-8 of the
// triangle's size if the triangle is 100,000 times as long as high.
NearestPoint nearestOnTriangle(const Vector& p, const std::array<Vector, 3>& corners) noexcept;

}  // namespace merlin::render::compare
