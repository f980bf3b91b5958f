#include "render/tiles/tile_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace merlin::render {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

// How far to the left the middle of a tile is, in radians. A whole circle of tiles stays in order,
// since `turns` may exceed half of it.
double leftwards(const Tile& tile, const TileSettings& settings, double field_of_view) {
  if (!settings.hasScreen())
    return settings.turns * field_of_view + settings.direction_deg[0] * kRadian;
  const Eigen::Vector3f middle(tile.projection(0, 2) / tile.projection(0, 0),
                               tile.projection(1, 2) / tile.projection(1, 1), -1);
  const Eigen::Vector3f seen = tile.view.topLeftCorner<3, 3>().transpose() * middle;
  return std::atan2(-seen.x(), -seen.z());
}

// Lays out wall tiles side by side, the leftmost first.
void layOutWall(TilePlan& plan, const TilesSettings& s) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    if (plan.tiles[i].kind == TileKind::kWall)
      order.emplace_back(leftwards(plan.tiles[i], s.tiles[i], s.field_of_view_deg * kRadian), i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [left, i] : order) {
    plan.tiles[i].wall_x = plan.wall_width;
    plan.wall_width += plan.tiles[i].width;
    plan.wall_height = std::max(plan.wall_height, plan.tiles[i].height);
  }
}

// Rotates by yaw, pitch and roll, in this order, as TileSettings::direction_deg says: the inverse,
// which takes eye to view coordinates.
Eigen::Matrix4f directionView(const std::array<double, 3>& degrees) {
  const auto radian = [&](std::size_t i) { return static_cast<float>(degrees[i] * kRadian); };
  const Eigen::Matrix3f turn = (Eigen::AngleAxisf(radian(0), Eigen::Vector3f::UnitY()) *
                                Eigen::AngleAxisf(radian(1), Eigen::Vector3f::UnitX()) *
                                Eigen::AngleAxisf(radian(2), Eigen::Vector3f::UnitZ()))
                                   .toRotationMatrix();
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.topLeftCorner<3, 3>() = turn.transpose();
  return view;
}

// The frustum through a screen: the view along its normal, its edges by their distances from that
// line (R. Kooima, "Generalized Perspective Projection", 2008).
void lookThrough(const std::array<double, 9>& screen, float near_m, float far_m, Tile& tile) {
  const auto corner = [&](std::size_t k) {
    return Eigen::Vector3d(screen[3 * k], screen[3 * k + 1], screen[3 * k + 2]);
  };
  const Eigen::Vector3d across = (corner(1) - corner(0)).normalized();
  const Eigen::Vector3d towards = across.cross(corner(2) - corner(0)).normalized();
  const Eigen::Vector3d up = towards.cross(across);
  const double distance = -corner(0).dot(towards);
  const auto tangent = [&](const Eigen::Vector3d& axis, std::size_t k) {
    return static_cast<float>(axis.dot(corner(k)) / distance);
  };
  tile.projection = offAxis(tangent(across, 0), tangent(across, 1), tangent(up, 0), tangent(up, 2),
                            near_m, far_m);
  tile.view.setIdentity();
  tile.view.block<1, 3>(0, 0) = across.cast<float>().transpose();
  tile.view.block<1, 3>(1, 0) = up.cast<float>().transpose();
  tile.view.block<1, 3>(2, 0) = towards.cast<float>().transpose();
}

Tile tileOf(const TileSettings& t, const TilesSettings& s) {
  const double fov = s.field_of_view_deg * kRadian;
  const auto near_m = static_cast<float>(s.near_m), far_m = static_cast<float>(s.far_m);
  Tile tile{t.name,
            t.kind,
            t.x,
            t.y,
            t.width > 0 ? t.width : s.tile_width,
            t.height > 0 ? t.height : s.tile_height,
            -1,
            {},
            {}};
  if (t.hasScreen()) {
    lookThrough(t.screen_m, near_m, far_m, tile);
    return tile;
  }
  tile.view = yawView(static_cast<float>(t.kind == TileKind::kWall ? t.turns * fov : 0));
  if (t.hasDirection()) tile.view = directionView(t.direction_deg) * tile.view;
  if (t.hasFrustum()) {
    const auto tangent = [&](std::size_t i) {
      return static_cast<float>(std::tan(t.frustum_deg[i] * kRadian));
    };
    tile.projection = offAxis(tangent(0), tangent(1), tangent(2), tangent(3), near_m, far_m);
  } else {
    tile.projection = perspective(static_cast<float>(fov),
                                  static_cast<float>(tile.width) / static_cast<float>(tile.height),
                                  near_m, far_m);
  }
  return tile;
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

Eigen::Matrix4f offAxis(float left, float right, float lower, float upper, float near_m,
                        float far_m) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
  m(0, 0) = 2 / (right - left);
  m(0, 2) = (right + left) / (right - left);
  m(1, 1) = 2 / (upper - lower);
  m(1, 2) = (upper + lower) / (upper - lower);
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
  for (const TileSettings& t : s.tiles) plan.tiles.push_back(tileOf(t, s));
  layOutWall(plan, s);
  return plan;
}

}  // namespace merlin::render
