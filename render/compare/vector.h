// Vector: a 3D vector of doubles and its operations.
#pragma once

namespace merlin::render::compare {

struct Vector {
  double x = 0, y = 0, z = 0;

  friend Vector operator+(const Vector& a, const Vector& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vector operator-(const Vector& a, const Vector& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vector operator*(double s, const Vector& v) noexcept {
    return {s * v.x, s * v.y, s * v.z};
  }
};

inline double dot(const Vector& a, const Vector& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double squared(const Vector& v) noexcept { return dot(v, v); }
inline Vector cross(const Vector& a, const Vector& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector vectorAt(const float* p) noexcept { return {p[0], p[1], p[2]}; }

}  // namespace merlin::render::compare
