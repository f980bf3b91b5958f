#include "render/tiles/tile_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace merlin::render {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

Error wrong(std::string what) { return {Errc::kInvalidArgument, std::move(what)}; }

bool overlap(const TileSettings& a, const TileSettings& b, const TilesSettings& s) {
  return std::abs(a.x - b.x) < s.tile_width && std::abs(a.y - b.y) < s.tile_height;
}

Result<Ok> checkPair(const TileSettings& a, const TileSettings& b, const TilesSettings& s) {
  if (a.name == b.name) return wrong(fmt::format("two tiles are named \"{}\"", a.name));
  if (overlap(a, b, s))
    return wrong(fmt::format("tiles {} and {} overlap in the frame", a.name, b.name));
  const bool both = a.kind == TileKind::kWall && b.kind == TileKind::kWall;
  if (both && std::abs(a.turns - b.turns) < 1e-6) {
    return wrong(fmt::format("tiles {} and {} both look {} tile widths to the left", a.name, b.name,
                             a.turns));
  }
  return Ok{};
}

Result<Ok> check(const TilesSettings& s) {
  if (!(s.field_of_view_deg >= 1 && s.field_of_view_deg <= 179)) {
    return wrong(fmt::format("a field of view of {} degrees is not 1 to 179", s.field_of_view_deg));
  }
  if (!(s.near_m > 0 && s.far_m > s.near_m && std::isfinite(s.far_m))) {
    return wrong(fmt::format("near {} m and far {} m: 0 < near < far", s.near_m, s.far_m));
  }
  if (s.tile_width <= 0 || s.tile_height <= 0) {
    return wrong(
        fmt::format("a tile of {} x {} pixels has no picture", s.tile_width, s.tile_height));
  }
  if (s.tiles.empty()) return wrong("a wall has at least one tile");
  for (std::size_t i = 0; i < s.tiles.size(); ++i) {
    const TileSettings& t = s.tiles[i];
    if (t.x < 0 || t.y < 0 || t.x > s.frame_width - s.tile_width ||
        t.y > s.frame_height - s.tile_height) {
      return wrong(fmt::format("tile {} at {}, {} does not lie in the frame of {} x {}", t.name,
                               t.x, t.y, s.frame_width, s.frame_height));
    }
    if (!std::isfinite(t.turns))
      return wrong(fmt::format("tile {}: turns are {}", t.name, t.turns));
    for (std::size_t j = 0; j < i; ++j) {
      if (const auto pair = checkPair(s.tiles[j], t, s); !pair) return pair;
    }
  }
  return Ok{};
}

// Wall tiles side by side, the one that looks furthest left first.
void layOutWall(TilePlan& plan, const TilesSettings& s) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    if (plan.tiles[i].kind == TileKind::kWall) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return s.tiles[a].turns > s.tiles[b].turns; });
  for (const std::size_t i : order) {
    plan.tiles[i].wall_x = plan.wall_width;
    plan.wall_width += s.tile_width;
  }
  plan.wall_height = order.empty() ? 0 : s.tile_height;
}

// Of the six planes of a frustum in clip coordinates, one that all eight corners are beyond.
bool isBeyondOne(const Eigen::Matrix4f& clip_from_box) noexcept {
  int beyond[6] = {};
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto side = [&](unsigned axis) { return (corner >> axis & 1) != 0 ? 1.0F : -1.0F; };
    const Eigen::Vector4f p = clip_from_box * Eigen::Vector4f(side(0), side(1), side(2), 1);
    for (int axis = 0; axis < 3; ++axis) {
      beyond[2 * axis] += p[axis] <= p[3] ? 0 : 1;  // a NaN is beyond
      beyond[2 * axis + 1] += p[axis] >= -p[3] ? 0 : 1;
    }
  }
  return std::any_of(std::begin(beyond), std::end(beyond), [](int n) { return n == 8; });
}

}  // namespace

Eigen::Matrix4f perspective(float field_of_view_rad, float aspect, float near_m, float far_m) {
  const float x = 1 / std::tan(field_of_view_rad / 2);
  Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
  m(0, 0) = x;
  m(1, 1) = x * aspect;
  m(2, 2) = (far_m + near_m) / (near_m - far_m);
  m(2, 3) = 2 * far_m * near_m / (near_m - far_m);
  m(3, 2) = -1;
  return m;
}

Eigen::Matrix4f operatorView(const Eigen::Matrix4f& projection, const Eigen::Vector3f& centre,
                             float radius) {
  // The narrower of the two half angles decides: sin of atan(1 / m).
  const float steepest = std::max(projection(0, 0), projection(1, 1));
  const float distance = radius * std::sqrt(1 + steepest * steepest);
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.block<3, 1>(0, 3) = -centre - Eigen::Vector3f(0, 0, distance);
  return m;
}

bool seesBox(const TilePlan& plan, const Eigen::Matrix4f& T_eye_box) noexcept {
  return std::any_of(plan.tiles.begin(), plan.tiles.end(), [&](const Tile& t) {
    return t.kind == TileKind::kWall && !isBeyondOne(t.projection * t.view * T_eye_box);
  });
}

Eigen::Matrix4f yawView(float yaw_rad) {
  // The inverse of turning the eye by +yaw about y.
  const float c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m(0, 0) = c;
  m(0, 2) = -s;
  m(2, 0) = s;
  m(2, 2) = c;
  return m;
}

Result<TilePlan> planTiles(const TilesSettings& s) {
  if (const auto checked = check(s); !checked) return checked.error();
  TilePlan plan{s.frame_width, s.frame_height, 0, 0, {}};
  const double fov = s.field_of_view_deg * kRadian;
  const Eigen::Matrix4f projection = perspective(
      static_cast<float>(fov), static_cast<float>(s.tile_width) / static_cast<float>(s.tile_height),
      static_cast<float>(s.near_m), static_cast<float>(s.far_m));
  for (const TileSettings& t : s.tiles) {
    Tile tile{t.name, t.kind, t.x, t.y, s.tile_width, s.tile_height, -1, projection, {}};
    tile.view = yawView(static_cast<float>(t.kind == TileKind::kWall ? t.turns * fov : 0));
    plan.tiles.push_back(std::move(tile));
  }
  layOutWall(plan, s);
  return plan;
}

}  // namespace merlin::render
