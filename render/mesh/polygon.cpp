#include "render/mesh/polygon.h"

#include <array>
#include <cmath>

namespace merlin::render::mesh {
namespace {

using Vector = std::array<double, 3>;
using PlanePoint = std::array<double, 2>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double innerProduct(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns twice the area of the triangle; positive if it is counter-clockwise.
double area(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// A face, given by a function that returns the position of each corner.
template <typename PositionOf>
class Face {
 public:
  Face(std::size_t corners, const PositionOf& position_of)
      : corners_(corners), position_of_(position_of) {}

  // Returns the position relative to the first corner, since coordinates may be large.
  Vector at(std::size_t corner) const {
    const float* const p = position_of_(corner);
    const float* const first = position_of_(0);
    return {double{p[0]} - first[0], double{p[1]} - first[1], double{p[2]} - first[2]};
  }

  // Returns the normal of the fan's triangle at corners 0, k and k + 1; its length is twice the
  // area.
  Vector normalAt(std::size_t k) const { return cross(at(k), at(k + 1)); }

  // Returns Newell's normal, which is the sum of the normals of the fan's triangles.
  Vector normal() const {
    Vector sum{};
    for (std::size_t k = 1; k + 1 < corners_; ++k) {
      const Vector n = normalAt(k);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += n[i];
    }
    return sum;
  }

  // Returns whether no triangle of the fan faces the other way, apart from rounding errors of
  // floats.
  bool isFan(const Vector& normal) const {
    constexpr double kRounding = 1e-7;
    const double least = -kRounding * innerProduct(normal, normal);
    for (std::size_t k = 1; k + 1 < corners_; ++k) {
      if (innerProduct(normalAt(k), normal) < least) return false;
    }
    return true;
  }

 private:
  std::size_t corners_;
  const PositionOf& position_of_;
};

// Returns the two axes of the plane's coordinates: all but the axis of the normal's largest
// component, in the order that keeps the polygon counter-clockwise.
std::array<std::size_t, 2> axesAcross(const Vector& normal) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[longest])) longest = k;
  }
  const std::size_t u = (longest + 1) % 3, v = (longest + 2) % 3;
  return normal[longest] > 0 ? std::array{u, v} : std::array{v, u};
}

// Triangulates a polygon by cutting off one ear after the other. An ear is a corner whose triangle
// with its two neighbours lies within the polygon. A cut changes only two other corners, so each
// cut takes O(corners).
class EarCutter {
 public:
  explicit EarCutter(std::vector<PlanePoint> points)
      : points_(std::move(points)),
        next_(points_.size()),
        before_(points_.size()),
        ear_(points_.size()) {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      before_[i] = (i + n - 1) % n;
    }
    for (std::size_t i = 0; i < n; ++i) ear_[i] = isEar(i);
  }

  // Returns three corners for each triangle; an empty vector if a polygon without an ear is left.
  std::vector<std::uint32_t> cut() {
    std::size_t at = 0;
    for (std::size_t left = points_.size(); left > 3; --left) {
      if (!findEar(left, at)) return {};
      take(at);
      const std::size_t before = before_[at], next = next_[at];
      next_[before] = next;
      before_[next] = before;
      ear_[before] = isEar(before);
      ear_[next] = isEar(next);
      at = next_[next];  // otherwise triangles around one corner would be long and thin
    }
    if (areaAt(at) < 0) return {};
    take(at);
    return std::move(triangles_);
  }

 private:
  double areaAt(std::size_t i) const {
    return area(points_[before_[i]], points_[i], points_[next_[i]]);
  }

  bool isEar(std::size_t i) const {
    if (!(areaAt(i) > 0)) return false;
    const std::size_t end = before_[i];
    for (std::size_t k = next_[next_[i]]; k != end; k = next_[k]) {
      if (isInTheWay(k, i)) return false;
    }
    return true;
  }

  // Returns whether corner k lies in the triangle at corner i or on its edge. Ignores convex
  // corners: a convex corner never lies there without another one that is not convex.
  bool isInTheWay(std::size_t k, std::size_t i) const {
    const PlanePoint &a = points_[before_[i]], &b = points_[i], &c = points_[next_[i]],
                     &p = points_[k];
    if (area(c, a, p) < 0 || area(a, b, p) < 0 || area(b, c, p) < 0) return false;
    return areaAt(k) <= 0 && p != a && p != b && p != c;
  }

  // Advances `at` to the next ear. If there is none, advances it to a flat corner, where the
  // outline does not turn. Returns false if there is neither.
  bool findEar(std::size_t left, std::size_t& at) const {
    const std::size_t from = at;
    for (std::size_t n = 0; n < left; ++n, at = next_[at]) {
      if (ear_[at]) return true;
    }
    at = from;
    for (std::size_t n = 0; n < left; ++n, at = next_[at]) {
      if (areaAt(at) == 0) return true;
    }
    return false;
  }

  void take(std::size_t i) {
    for (const std::size_t k : {before_[i], i, next_[i]})
      triangles_.push_back(static_cast<std::uint32_t>(k));
  }

  std::vector<PlanePoint> points_;
  std::vector<std::size_t> next_, before_;
  std::vector<bool> ear_;
  std::vector<std::uint32_t> triangles_;
};

template <typename PositionOf>
std::vector<std::uint32_t> cutFace(std::size_t corners, const PositionOf& position_of) {
  if (corners <= 3 || corners > kMostCutCorners) return {};
  const Face face(corners, position_of);
  const Vector normal = face.normal();
  const double size = innerProduct(normal, normal);
  if (!std::isfinite(size) || size == 0 || face.isFan(normal)) return {};
  const auto [u, v] = axesAcross(normal);
  std::vector<PlanePoint> points;
  points.reserve(corners);
  for (std::size_t k = 0; k < corners; ++k) {
    const Vector p = face.at(k);
    points.push_back({p[u], p[v]});
  }
  return EarCutter(std::move(points)).cut();
}

// Function object that returns the position of each corner of a fan.
class CornersOf {
 public:
  CornersOf(const Mesh& mesh, const Fan& fan)
      : mesh_(mesh), vertices_(&mesh.triangles[3 * fan.triangle]) {}

  std::size_t vertex(std::size_t corner) const {
    return vertices_[corner < 2 ? corner : 3 * (corner - 2) + 2];
  }
  const float* operator()(std::size_t corner) const { return &mesh_.positions[3 * vertex(corner)]; }

 private:
  const Mesh& mesh_;
  const std::uint32_t* vertices_;
};

bool areThere(const CornersOf& corners, std::size_t count, std::size_t vertices) {
  for (std::size_t k = 0; k < count; ++k) {
    if (corners.vertex(k) >= vertices) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> cutPolygon(std::span<const float> positions) {
  return cutFace(positions.size() / 3, [&](std::size_t k) { return &positions[3 * k]; });
}

void Fans::take(const Mesh& mesh, std::size_t corners) {
  if (corners <= 3 || corners > kMostCutCorners) return;
  const Fan fan{mesh.triangleCount() - (corners - 2), corners};
  const CornersOf at(mesh, fan);
  if (areThere(at, corners, mesh.vertexCount())) {
    const Face face(corners, at);
    if (face.isFan(face.normal())) return;
  }
  fans_.push_back(fan);
}

void Fans::cut(Mesh& mesh, const OnCut& on_cut) {
  for (const Fan& fan : fans_) {
    const CornersOf at(mesh, fan);
    if (!areThere(at, fan.corners, mesh.vertexCount())) continue;
    const auto order = cutFace(fan.corners, at);
    if (order.empty()) continue;
    reorder(fan, order, mesh.triangles);
    if (on_cut) on_cut(fan, order);
  }
  fans_.clear();
}

}  // namespace merlin::render::mesh
