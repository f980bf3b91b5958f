#include "render/compare/triangle_distance.h"

#include <algorithm>
#include <limits>

namespace merlin::render::compare {
namespace {

// A triangle whose (height / longest edge)^2 is below this is a sliver: rounding may put a point on
// the wrong side of one of its edges.
constexpr double kSliver = 1e-10;

// Returns the point nearest to p on the edge from corner i to corner j.
NearestPoint nearestOnEdge(const Vector& p, const std::array<Vector, 3>& corners, std::size_t i,
                           std::size_t j) noexcept {
  const Vector edge = corners[j] - corners[i];
  const double length2 = squared(edge);
  const double along =
      length2 > 0 ? std::clamp(dot(p - corners[i], edge) / length2, 0.0, 1.0) : 0.0;
  NearestPoint nearest{squared(p - (corners[i] + along * edge)), {0, 0, 0}};
  nearest.barycentric[i] = 1 - along;
  nearest.barycentric[j] = along;
  return nearest;
}

}  // namespace

NearestPoint nearestOnTriangle(const Vector& p, const std::array<Vector, 3>& corners) noexcept {
  const Vector ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = p - corners[0];
  const Vector n = cross(ab, ac);
  const double nn = squared(n);
  const double b = dot(n, cross(ap, ac)), c = dot(n, cross(ab, ap));
  const std::array<double, 3> side = {nn - b - c, b, c};  // barycentric coordinates x nn
  const double longest2 = std::max({squared(ab), squared(ac), squared(corners[2] - corners[1])});
  const bool sliver = nn <= kSliver * longest2 * longest2;
  NearestPoint best{std::numeric_limits<double>::infinity(), {}};
  if (nn > 0 && side[0] >= 0 && side[1] >= 0 && side[2] >= 0) {
    const double height = dot(n, ap);
    best = {height * height / nn, {side[0] / nn, side[1] / nn, side[2] / nn}};
    if (!sliver) return best;
  }
  // If p is outside, the nearest point lies on an edge that has p on its outer side.
  for (std::size_t k = 0; k < 3; ++k) {
    if (!sliver && side[k] >= 0) continue;
    const NearestPoint on_edge = nearestOnEdge(p, corners, (k + 1) % 3, (k + 2) % 3);
    if (on_edge.distance2 < best.distance2) best = on_edge;
  }
  return best;
}

}  // namespace merlin::render::compare
