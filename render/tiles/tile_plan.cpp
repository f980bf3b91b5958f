#include "render/tiles/tile_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::render {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

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

// Whether all eight corners lie beyond one of the six planes of a frustum in clip coordinates.
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
  if (const SettingFaults faults = validate(s); !faults.empty())
    return Error{Errc::kInvalidArgument, faults.front().what};
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
