#include "render/tiles/wall_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "daemon/base/radian.h"

namespace merlin::render::tiles {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-4;  // places that differ by less are equal [rad or m]

// The range that a tile covers along one axis. `rank`: `middle` in steps of kSame, so that rounding
// does not change the order of tiles.
struct Extent {
  double middle = 0, half = 0;
  std::int64_t rank() const { return std::llround(middle / kSame); }
  bool isApartFrom(const Extent& o) const {
    return std::abs(middle - o.middle) > std::max(half, o.half) - kSame;
  }
};

struct SeenTile {
  Tile* tile;
  Extent across, down;  // positive to the right and downwards
};

// Returns the direction through a point of the tile's picture; x and y in -1..1, right and up.
Vector3d directionOf(const Tile& tile, double x, double y) {
  const Eigen::Matrix4d p = tile.projection.cast<double>();
  const Vector3d inside((x + p(0, 2)) / p(0, 0), (y + p(1, 2)) / p(1, 1), -1);
  return tile.view.topLeftCorner<3, 3>().transpose().cast<double>() * inside;
}
double yawOf(const Vector3d& direction) { return std::atan2(-direction.x(), -direction.z()); }
double pitchOf(const Vector3d& direction) {
  return std::atan2(direction.y(), std::hypot(direction.x(), direction.z()));
}

// Returns the directions to the middles of the picture's four edges.
std::array<Vector3d, 4> edgesOf(const Tile& tile) {
  return {directionOf(tile, -1, 0), directionOf(tile, 1, 0), directionOf(tile, 0, -1),
          directionOf(tile, 0, 1)};
}

// A full circle of tiles keeps its order, since `turns` may exceed half a circle; a screen straight
// behind the eye counts as the leftmost.
Extent acrossOf(const Tile& tile, const TileSettings& settings, double field_of_view) {
  const double yaw = yawOf(directionOf(tile, 0, 0));
  double left = yaw;
  if (!settings.hasScreen())
    left = settings.turns * field_of_view + settings.direction_deg[0] * kRadian<double>;
  else if (yaw < kSame - std::numbers::pi)
    left = yaw + 2 * std::numbers::pi;
  Extent extent{-left, 0};
  for (const Vector3d& edge : edgesOf(tile)) {
    const double off = std::remainder(yawOf(edge) - yaw, 2 * std::numbers::pi);
    extent.half = std::max(extent.half, std::abs(off));
  }
  return extent;
}

Extent downByAngle(const Tile& tile) {
  Extent extent{-pitchOf(directionOf(tile, 0, 0)), 0};
  for (const Vector3d& edge : edgesOf(tile))
    extent.half = std::max(extent.half, std::abs(-pitchOf(edge) - extent.middle));
  return extent;
}

// Measures in metres, since a far screen of the same row is seen at another angle.
Extent downByHeight(const std::array<double, 9>& screen) {
  const double across = screen[4] - screen[1], up = screen[7] - screen[1];
  return {-(screen[1] + (across + up) / 2), (std::abs(across) + std::abs(up)) / 2};
}

std::vector<SeenTile> seenTiles(TilePlan& plan, const TilesSettings& s) {
  std::vector<SeenTile> seen;
  bool all_have_screens = true;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    Tile& tile = plan.tiles[i];
    if (!tile.followsWall() || tile.eye == Eye::kRight) continue;
    seen.push_back({&tile, acrossOf(tile, s.tiles[i], s.field_of_view_deg * kRadian<double>), {}});
    all_have_screens = all_have_screens && s.tiles[i].hasScreen();
  }
  for (SeenTile& t : seen)
    t.down = all_have_screens ? downByHeight(t.tile->screen_m) : downByAngle(*t.tile);
  return seen;
}

}  // namespace

void layOutWall(TilePlan& plan, const TilesSettings& settings) {
  std::vector<SeenTile> seen = seenTiles(plan, settings);
  const auto across = [](const SeenTile& t) { return t.across.rank(); };
  const auto down = [](const SeenTile& t) { return t.down.rank(); };
  std::ranges::stable_sort(seen, {}, across);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Tile& tile = *seen[i].tile;
    tile.wall_x = 0;
    for (std::size_t k = 0; k < i; ++k) {
      const bool above_one_another =
          !seen[k].across.isApartFrom(seen[i].across) && seen[k].down.isApartFrom(seen[i].down);
      if (!above_one_another)
        tile.wall_x = std::max(tile.wall_x, seen[k].tile->wall_x + seen[k].tile->width);
    }
    plan.wall_width = std::max(plan.wall_width, tile.wall_x + tile.width);
  }
  std::ranges::stable_sort(seen, {}, down);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Tile& tile = *seen[i].tile;
    tile.wall_y = 0;
    for (std::size_t k = 0; k < i; ++k) {
      if (seen[k].down.isApartFrom(seen[i].down))
        tile.wall_y = std::max(tile.wall_y, seen[k].tile->wall_y + seen[k].tile->height);
    }
    plan.wall_height = std::max(plan.wall_height, tile.wall_y + tile.height);
  }
}

}  // namespace merlin::render::tiles
