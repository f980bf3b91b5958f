#include "render/room/tile_table.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "daemon/base/radian.h"
#include "render/room/geometry.h"
#include "render/tiles/plane_parts.h"

namespace merlin::render::room {
namespace {

// Tangents of the angles between a tile's direction and its edges.
struct Edges {
  double left, right, lower, upper;
};

Edges edgesOf(const Eigen::Matrix4f& projection) {
  const auto tangent = [&](int axis, double side) {
    return (static_cast<double>(projection(axis, 2)) + side) /
           static_cast<double>(projection(axis, axis));
  };
  return {tangent(0, -1), tangent(0, 1), tangent(1, -1), tangent(1, 1)};
}

// Normalises an angle for display: -0 becomes 0, and -180 becomes 180.
double plainAngle(double degrees) {
  constexpr double kRounding = 1e-4;
  if (std::abs(degrees) < kRounding) return 0;
  return degrees < kRounding - 180 ? degrees + 360 : degrees;
}

Eigen::Vector3d inEyeCoordinates(const tiles::Tile& tile, double x, double y) {
  return tile.view.topLeftCorner<3, 3>().transpose().cast<double>() * Eigen::Vector3d(x, y, -1);
}

Screen screenOf(const tiles::TileSettings& t) {
  const Eigen::Matrix3d corners = Eigen::Map<const Eigen::Matrix3d>(t.screen_m.data());
  return {corners.col(0), corners.col(1) - corners.col(0), corners.col(2) - corners.col(0)};
}

TileFigures figuresOf(const tiles::TileSettings& settings, const tiles::Tile& tile) {
  TileFigures f{tile.name, tile.kind, tile.x, tile.y, tile.width, tile.height};
  f.view = tile.camera;
  if (tile.isFitted() && tile.kind != tiles::TileKind::kOperator) return f;
  const Edges e = edgesOf(tile.projection);
  f.horizontal_deg = (std::atan(e.right) - std::atan(e.left)) / kRadian<double>;
  f.vertical_deg = (std::atan(e.upper) - std::atan(e.lower)) / kRadian<double>;
  const Eigen::Vector3d middle =
      inEyeCoordinates(tile, (e.left + e.right) / 2, (e.lower + e.upper) / 2);
  f.yaw_deg = plainAngle(std::atan2(-middle.x(), -middle.z()) / kRadian<double>);
  f.pitch_deg =
      plainAngle(std::atan2(middle.y(), std::hypot(middle.x(), middle.z())) / kRadian<double>);
  if (!settings.hasScreen()) return f;
  const Screen screen = screenOf(settings);
  const double width = screen.across.norm(), height = screen.up.norm();
  f.screen = ScreenFigures{width,
                           height,
                           {1000 * width / tile.width, 1000 * height / tile.height},
                           screen.middle().norm()};
  return f;
}

// Returns the length of the intersection of two intervals [low, low + length]; negative if they are
// disjoint.
double common(double low1, double length1, double low2, double length2) {
  return std::min(low1 + length1, low2 + length2) - std::max(low1, low2);
}

std::optional<TileOverlap> overlapOf(const tiles::Tile& a, const tiles::PlanePart& first,
                                     const tiles::Tile& b, const tiles::PlanePart& second) {
  constexpr double kLeast_m = 0.001;
  const double width = common(first.left, first.width, second.left, second.width);
  const double height = common(first.top, first.height, second.top, second.height);
  if (first.plane != second.plane || width < kLeast_m || height < kLeast_m) return std::nullopt;
  const auto pixels = [&](const tiles::Tile& tile, const tiles::PlanePart& part) {
    return std::array{static_cast<int>(std::lround(width / part.width * tile.width)),
                      static_cast<int>(std::lround(height / part.height * tile.height))};
  };
  if (second.left >= first.left)
    return TileOverlap{a.name, b.name, width, height, pixels(a, first), pixels(b, second)};
  return TileOverlap{b.name, a.name, width, height, pixels(b, second), pixels(a, first)};
}

}  // namespace

std::vector<TileFigures> tileTable(const tiles::TilesSettings& settings,
                                   const tiles::TilePlan& plan) {
  std::vector<TileFigures> table;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i)
    table.push_back(figuresOf(settings.tiles[i], plan.tiles[i]));
  return table;
}

std::vector<TileOverlap> tileOverlaps(const tiles::TilePlan& plan) {
  const auto parts = tiles::planeParts(plan);
  std::vector<TileOverlap> overlaps;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const tiles::Tile &a = plan.tiles[k], &b = plan.tiles[i];
      if (!parts[k] || !parts[i] || a.eye != b.eye) continue;
      if (const auto overlap = overlapOf(a, *parts[k], b, *parts[i])) overlaps.push_back(*overlap);
    }
  }
  return overlaps;
}

Corners cornersOf(const tiles::TileSettings& settings, const tiles::Tile& tile, double distance_m) {
  std::array<Eigen::Vector3d, 4> at;
  if (settings.hasScreen()) {
    const Screen s = screenOf(settings);
    at = {s.corner, s.corner + s.across, s.corner + s.across + s.up, s.corner + s.up};
  } else {
    const Edges e = edgesOf(tile.projection);
    at = {inEyeCoordinates(tile, e.left, e.lower), inEyeCoordinates(tile, e.right, e.lower),
          inEyeCoordinates(tile, e.right, e.upper), inEyeCoordinates(tile, e.left, e.upper)};
    for (Eigen::Vector3d& corner : at) corner *= distance_m;
  }
  Corners corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {at[i].x(), at[i].y(), at[i].z()};
  return corners;
}

}  // namespace merlin::render::room
