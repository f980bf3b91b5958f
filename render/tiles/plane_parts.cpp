#include "render/tiles/plane_parts.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace merlin::render::tiles {
namespace {

constexpr double kLeast_m = 0.001;

// A plane, with the rectangle around its tiles so far. The rectangle is measured from the lower
// left corner of the first tile, to the right and up.
struct Plane {
  Eigen::Vector3d corner, right, up;
  double left = 0, end = 0, low = 0, high = 0;  // [m]
};

struct Screen {
  Eigen::Vector3d corner, across, up;  // lower left; the edges from there
};

std::optional<Screen> screenOf(const Tile& tile) {
  const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(tile.screen_m.data());
  if (corners.isZero(0)) return std::nullopt;
  return Screen{corners.col(0), corners.col(1) - corners.col(0), corners.col(2) - corners.col(0)};
}

bool liesOn(const Plane& plane, const Screen& screen) {
  constexpr double kSame = 1 - 1e-9;
  const Eigen::Vector3d normal = plane.right.cross(plane.up);
  return plane.right.dot(screen.across.normalized()) > kSame &&
         plane.up.dot(screen.up.normalized()) > kSame &&
         std::abs(normal.dot(screen.corner - plane.corner)) < kLeast_m;
}

// Adds a tile to the plane. Returns its part, with `top` still upwards from the plane's corner.
PlanePart addTo(Plane& plane, std::size_t number, const Screen& screen) {
  const Eigen::Vector3d from = screen.corner - plane.corner;
  const double left = plane.right.dot(from), low = plane.up.dot(from);
  const double width = screen.across.norm(), height = screen.up.norm();
  plane.left = std::min(plane.left, left);
  plane.end = std::max(plane.end, left + width);
  plane.low = std::min(plane.low, low);
  plane.high = std::max(plane.high, low + height);
  return {number, left, low + height, width, height};
}

// Returns how much of the interval from `from` to `to` another interval covers at its lower end; 0
// unless the other one begins before it and ends within it.
double coveredFrom(double from, double to, double other_from, double other_to) {
  const bool begins_before = other_from < from - kLeast_m, ends_within = other_to < to - kLeast_m;
  return begins_before && ends_within ? std::max(0.0, other_to - from) : 0;
}

bool meet(double from, double length, double other_from, double other_length) {
  return std::min(from + length, other_from + other_length) - std::max(from, other_from) > kLeast_m;
}

void widen(SharedStrips& s, const PlanePart& a, const PlanePart& b) {
  if (meet(a.top, a.height, b.top, b.height)) {
    const double a_end = a.left + a.width, b_end = b.left + b.width;
    s.left = std::max(s.left, coveredFrom(a.left, a_end, b.left, b_end));
    s.right = std::max(s.right, coveredFrom(-a_end, -a.left, -b_end, -b.left));
  }
  if (meet(a.left, a.width, b.left, b.width)) {
    const double a_end = a.top + a.height, b_end = b.top + b.height;
    s.top = std::max(s.top, coveredFrom(a.top, a_end, b.top, b_end));
    s.bottom = std::max(s.bottom, coveredFrom(-a_end, -a.top, -b_end, -b.top));
  }
}

}  // namespace

std::vector<std::optional<PlanePart>> planeParts(const TilePlan& plan) {
  std::vector<Plane> planes;
  std::vector<std::optional<PlanePart>> parts;
  for (const Tile& tile : plan.tiles) {
    const auto screen = screenOf(tile);
    parts.emplace_back();
    if (!screen) continue;
    auto on = std::ranges::find_if(planes, [&](const Plane& p) { return liesOn(p, *screen); });
    if (on == planes.end())
      on = planes.insert(planes.end(),
                         {screen->corner, screen->across.normalized(), screen->up.normalized()});
    parts.back() = addTo(*on, static_cast<std::size_t>(on - planes.begin()), *screen);
  }
  for (auto& part : parts) {
    if (!part) continue;
    const Plane& plane = planes[part->plane];
    part->left -= plane.left;
    part->top = plane.high - part->top;
    part->plane_width = plane.end - plane.left;
    part->plane_height = plane.high - plane.low;
  }
  return parts;
}

std::vector<SharedStrips> sharedStrips(const TilePlan& plan,
                                       const std::vector<std::optional<PlanePart>>& parts) {
  std::vector<SharedStrips> all(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const bool together = i != j && parts[i] && parts[j] && parts[i]->plane == parts[j]->plane &&
                            plan.tiles[i].eye == plan.tiles[j].eye;
      if (together) widen(all[i], *parts[i], *parts[j]);
    }
  }
  return all;
}

}  // namespace merlin::render::tiles
