#include "render/tiles/tile_plan.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "daemon/base/radian.h"
#include "render/tiles/wall_layout.h"

namespace merlin::render::tiles {
namespace {

// Returns the view matrix (eye to view coordinates) of TileSettings::direction_deg: the inverse of
// the rotation by yaw, pitch and roll, in this order.
Eigen::Matrix4f directionView(const std::array<double, 3>& degrees) {
  const auto radian = [&](std::size_t i) {
    return static_cast<float>(degrees[i] * kRadian<double>);
  };
  const Eigen::Matrix3f turn = (Eigen::AngleAxisf(radian(0), Eigen::Vector3f::UnitY()) *
                                Eigen::AngleAxisf(radian(1), Eigen::Vector3f::UnitX()) *
                                Eigen::AngleAxisf(radian(2), Eigen::Vector3f::UnitZ()))
                                   .toRotationMatrix();
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.topLeftCorner<3, 3>() = turn.transpose();
  return view;
}

// Sets the camera that sees exactly the tile's screen from `eye`: its view direction is the
// screen's normal, and the frustum's edges are the screen's edges (R. Kooima, "Generalized
// Perspective Projection", 2008).
void lookThroughScreen(const Eigen::Vector3d& eye, double nearest_m, double farthest_m,
                       Tile& tile) {
  const auto near_m = static_cast<float>(nearest_m), far_m = static_cast<float>(farthest_m);
  const auto corner = [&](std::size_t k) {
    return Eigen::Vector3d(Eigen::Vector3d(&tile.screen_m[3 * k]) - eye);
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
  if (!eye.isZero(0))
    tile.view.block<3, 1>(0, 3) = -tile.view.topLeftCorner<3, 3>() * eye.cast<float>();
}

// Returns whether an eye sees the front of a screen, less than 179 degrees wide and high.
bool seesFront(const std::array<double, 9>& screen, const Eigen::Vector3d& eye) {
  constexpr double kWidest = 179 * kRadian<double>;
  const Eigen::Vector3d corner = Eigen::Vector3d(&screen[0]) - eye;
  const Eigen::Vector3d across = Eigen::Vector3d(&screen[3]) - eye - corner;
  const Eigen::Vector3d up = Eigen::Vector3d(&screen[6]) - eye - corner;
  const double distance = -corner.dot(across.cross(up).normalized());
  const auto isWithin = [&](const Eigen::Vector3d& edge) {
    const double low = corner.dot(edge.normalized());
    return std::atan2(low + edge.norm(), distance) - std::atan2(low, distance) < kWidest;
  };
  return distance > 1e-3 && isWithin(across) && isWithin(up);
}

void lookThrough(const FreeCamera& camera, const TilesSettings& s, Tile& tile) {
  const Eigen::Vector3d eye(camera.eye_m.data()), at(camera.look_at_m.data());
  const Eigen::Vector3d back = (eye - at).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(camera.up.data()).cross(back).normalized();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = back.cross(right).transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = -view.topLeftCorner<3, 3>() * eye;
  tile.view = view.cast<float>();
  tile.projection = perspective(static_cast<float>(camera.field_of_view_deg * kRadian<double>),
                                static_cast<float>(tile.width) / static_cast<float>(tile.height),
                                static_cast<float>(s.near_m), static_cast<float>(s.far_m));
}

Tile tileOf(const TileSettings& t, const TilesSettings& s) {
  const double fov = s.field_of_view_deg * kRadian<double>;
  const auto near_m = static_cast<float>(s.near_m), far_m = static_cast<float>(s.far_m);
  Tile tile{t.name,
            t.kind,
            t.x,
            t.y,
            t.width > 0 ? t.width : s.tile_width,
            t.height > 0 ? t.height : s.tile_height,
            -1,
            -1,
            {},
            {},
            t.view,
            t.eye,
            t.screen_m};
  if (t.view == TileCamera::kFree) {
    lookThrough(t.camera, s, tile);
    return tile;
  }
  if (t.hasScreen()) {
    const Viewer straight{Eigen::Vector3d::Zero(), Eigen::Vector3d(s.eyes_m.data())};
    lookThroughScreen(straight.placeOf(t.eye), s.near_m, s.far_m, tile);
    return tile;
  }
  tile.view = yawView(static_cast<float>(t.kind == TileKind::kWall ? t.turns * fov : 0));
  if (t.hasDirection()) tile.view = directionView(t.direction_deg) * tile.view;
  if (t.hasFrustum()) {
    const auto tangent = [&](std::size_t i) {
      return static_cast<float>(std::tan(t.frustum_deg[i] * kRadian<double>));
    };
    tile.projection = offAxis(tangent(0), tangent(1), tangent(2), tangent(3), near_m, far_m);
  } else {
    tile.projection = perspective(static_cast<float>(fov),
                                  static_cast<float>(tile.width) / static_cast<float>(tile.height),
                                  near_m, far_m);
  }
  return tile;
}

// Returns whether all eight corners lie outside the same one of the six planes of the clip volume.
bool isBeyondOne(const Eigen::Matrix4f& clip_from_box) noexcept {
  int beyond[6] = {};
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto side = [&](unsigned axis) { return (corner >> axis & 1) != 0 ? 1.0F : -1.0F; };
    const Eigen::Vector4f p = clip_from_box * Eigen::Vector4f(side(0), side(1), side(2), 1);
    for (int axis = 0; axis < 3; ++axis) {
      beyond[2 * axis] += p[axis] <= p[3] ? 0 : 1;  // NaN counts as outside
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
  // The narrower of the two half angles a, with tan a = 1 / m, decides: distance = radius / sin a.
  const float steepest = std::max(projection(0, 0), projection(1, 1));
  const float distance = radius * std::sqrt(1 + steepest * steepest);
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.block<3, 1>(0, 3) = -centre - Eigen::Vector3f(0, 0, distance);
  return m;
}

TileMatrices parallelMatrices(TileCamera camera, float aspect, const Eigen::Vector3f& centre,
                              float radius) {
  // The picture's right and up, in eye coordinates; the third axis points towards the camera.
  Eigen::Vector3f right = Eigen::Vector3f::UnitX(), up = Eigen::Vector3f::UnitY();
  if (camera == TileCamera::kTop) up = -Eigen::Vector3f::UnitZ();
  if (camera == TileCamera::kSide) right = -Eigen::Vector3f::UnitZ();
  TileMatrices matrices{Eigen::Matrix4f::Identity(), Eigen::Matrix4f::Identity()};
  matrices.view.block<1, 3>(0, 0) = right.transpose();
  matrices.view.block<1, 3>(1, 0) = up.transpose();
  matrices.view.block<1, 3>(2, 0) = right.cross(up).transpose();
  matrices.view.block<3, 1>(0, 3) = -matrices.view.topLeftCorner<3, 3>() * centre;
  matrices.projection(0, 0) = std::min(1.0F, 1 / aspect) / radius;
  matrices.projection(1, 1) = std::min(1.0F, aspect) / radius;
  // A little more depth than the sphere has, so that nothing of it is clipped.
  matrices.projection(2, 2) = -1 / (1.05F * radius);
  return matrices;
}

TileMatrices matricesOf(const Tile& tile, const Eigen::Vector3f& centre, float radius) {
  if (tile.kind == TileKind::kOperator)
    return {tile.projection, operatorView(tile.projection, centre, radius)};
  if (!tile.isFitted()) return {tile.projection, tile.view};
  return parallelMatrices(tile.camera,
                          static_cast<float>(tile.width) / static_cast<float>(tile.height), centre,
                          radius);
}

TileMatrices panoramaMatrices(const Tile& tile) {
  TileMatrices matrices{tile.projection, tile.view};
  matrices.view.block<3, 1>(0, 3).setZero();
  return matrices;
}

bool placeViewer(TilePlan& plan, const Viewer& viewer) {
  const auto isPlaced = [](const Tile& t) {
    return t.followsWall() && t.screen_m != std::array<double, 9>{};
  };
  for (const Tile& t : plan.tiles) {
    if (isPlaced(t) && !seesFront(t.screen_m, viewer.placeOf(t.eye))) return false;
  }
  for (Tile& t : plan.tiles) {
    if (isPlaced(t)) lookThroughScreen(viewer.placeOf(t.eye), plan.near_m, plan.far_m, t);
  }
  return true;
}

bool seesBox(const TilePlan& plan, const Eigen::Matrix4f& T_eye_box) noexcept {
  return std::any_of(plan.tiles.begin(), plan.tiles.end(), [&](const Tile& t) {
    return !t.isFitted() && !isBeyondOne(t.projection * t.view * T_eye_box);
  });
}

Eigen::Matrix4f yawView(float yaw_rad) {
  // The inverse of rotating the eye by +yaw about y.
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
  TilePlan plan{s.frame_width, s.frame_height, 0, 0, {}, s.near_m, s.far_m};
  for (const TileSettings& t : s.tiles) plan.tiles.push_back(tileOf(t, s));
  layOutWall(plan, s);
  return plan;
}

}  // namespace merlin::render::tiles
