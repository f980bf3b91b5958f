// Functions for 3D vectors of doubles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace merlin::render::compare {

using Vector = Eigen::Vector3d;

// Returns the dot product, with the products added in the order x, y, z. Eigen's dot() uses a
// different order, which would change the last bit of results.
inline double dot(const Vector& a, const Vector& b) noexcept {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}
inline double squared(const Vector& v) noexcept { return dot(v, v); }
inline Vector cross(const Vector& a, const Vector& b) noexcept { return a.cross(b); }
inline Vector vectorAt(const float* p) noexcept { return {p[0], p[1], p[2]}; }

}  // namespace merlin::render::compare
