#include "render/tiles/settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace merlin::render::tiles {
namespace {

int widthOf(const TileSettings& t, const TilesSettings& s) {
  return t.width > 0 ? t.width : s.tile_width;
}
int heightOf(const TileSettings& t, const TilesSettings& s) {
  return t.height > 0 ? t.height : s.tile_height;
}

bool overlap(const TileSettings& a, const TileSettings& b, const TilesSettings& s) {
  return a.x < b.x + widthOf(b, s) && b.x < a.x + widthOf(a, s) && a.y < b.y + heightOf(b, s) &&
         b.y < a.y + heightOf(a, s);
}

bool looksByTurnsAlone(const TileSettings& t) {
  return t.followsWall() && !t.hasDirection() && !t.hasFrustum() && !t.hasScreen();
}

std::optional<std::string> faultOfPair(const TileSettings& a, const TileSettings& b,
                                       const TilesSettings& s) {
  if (a.name == b.name) return fmt::format("two tiles are named \"{}\"", a.name);
  if (overlap(a, b, s)) return fmt::format("tiles {} and {} overlap in the frame", a.name, b.name);
  const bool both = looksByTurnsAlone(a) && looksByTurnsAlone(b);
  if (!both || std::abs(a.turns - b.turns) >= 1e-6) return std::nullopt;
  return fmt::format("tiles {} and {} have the same direction: {} tile widths to the left", a.name,
                     b.name, a.turns);
}

template <std::size_t N>
bool allFinite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::optional<std::string> faultOfFrustum(const TileSettings& t) {
  constexpr double kWidest_deg = 89.5;
  const auto& [left, right, lower, upper] = t.frustum_deg;
  const bool within =
      allFinite(t.frustum_deg) && std::all_of(t.frustum_deg.begin(), t.frustum_deg.end(),
                                              [](double a) { return std::abs(a) <= kWidest_deg; });
  if (within && left < right && lower < upper) return std::nullopt;
  return fmt::format(
      "tile {}: frustum_deg {}, {}, {}, {}: left must be less than right, lower less "
      "than upper, and each of -{} to {}",
      t.name, left, right, lower, upper, kWidest_deg, kWidest_deg);
}

// Rejects a screen that subtends 179 degrees or more, i.e. whose plane the eye almost touches.
std::optional<std::string> faultOfAngles(const std::string& name, const Eigen::Vector3d& corner,
                                         const Eigen::Vector3d& across, const Eigen::Vector3d& up) {
  constexpr double kWidest_deg = 179;
  const double distance = std::abs(corner.dot(across.cross(up).normalized()));
  const auto angle_deg = [&](const Eigen::Vector3d& edge) {
    const double low = corner.dot(edge.normalized());
    return (std::atan2(low + edge.norm(), distance) - std::atan2(low, distance)) * 180 /
           std::numbers::pi;
  };
  if (angle_deg(across) < kWidest_deg && angle_deg(up) < kWidest_deg) return std::nullopt;
  return fmt::format(
      "tile {}: screen_m: the screen is {:.2f} x {:.2f} degrees wide and high as seen from the "
      "eye; each must be less than {}",
      name, angle_deg(across), angle_deg(up), kWidest_deg);
}

// Rejects a screen that is not a rectangle (cosine of the angle between its edges above 0.01) or
// whose front the tile's eye does not see.
std::optional<std::string> faultOfScreen(const TileSettings& t, const TilesSettings& s) {
  if (!allFinite(t.screen_m))
    return fmt::format("tile {}: screen_m contains a value that is not a number", t.name);
  const double side = t.eye == Eye::kMiddle ? 0 : t.eye == Eye::kLeft ? -0.5 : 0.5;
  const Eigen::Vector3d eye = side * Eigen::Vector3d(s.eyes_m.data());
  const auto corner = [&](std::size_t k) {
    return Eigen::Vector3d(Eigen::Vector3d(&t.screen_m[3 * k]) - eye);
  };
  const Eigen::Vector3d across = corner(1) - corner(0), up = corner(2) - corner(0);
  const double size = across.norm() * up.norm();
  if (!(size > 1e-6) || std::abs(across.dot(up)) > 0.01 * size) {
    return fmt::format(
        "tile {}: screen_m: the lower left, lower right and upper left corner are not "
        "three corners of a rectangle",
        t.name);
  }
  if (!(-corner(0).dot(across.cross(up)) / size > 1e-3)) {
    return fmt::format(
        "tile {}: screen_m: the eye does not see its front (are the corners in the "
        "order lower left, lower right, upper left?)",
        t.name);
  }
  return faultOfAngles(t.name, corner(0), across, up);
}

std::optional<std::string> faultOfFreeCamera(const std::string& name, const FreeCamera& c) {
  if (!allFinite(c.eye_m) || !allFinite(c.look_at_m) || !allFinite(c.up))
    return fmt::format("tile {}: camera has something that is not a number", name);
  if (!(c.field_of_view_deg >= 1 && c.field_of_view_deg <= 179)) {
    return fmt::format("tile {}: camera: a field of view of {} degrees is not 1 to 179", name,
                       c.field_of_view_deg);
  }
  const Eigen::Vector3d sight =
      Eigen::Vector3d(c.look_at_m.data()) - Eigen::Vector3d(c.eye_m.data());
  if (!(sight.norm() > 1e-3)) {
    return fmt::format(
        "tile {}: camera: eye_m and look_at_m are the same place; the camera looks "
        "from the first to the second",
        name);
  }
  const Eigen::Vector3d up(c.up.data());
  if (sight.cross(up).norm() > 1e-3 * sight.norm() * up.norm()) return std::nullopt;
  return fmt::format(
      "tile {}: camera: up has no length or lies along the line of sight from eye_m "
      "to look_at_m; give another direction, such as 0, 0, -1 for a camera that "
      "looks straight down",
      name);
}

}  // namespace

std::optional<std::string> faultOfView(const TileSettings& t) {
  if (t.view != TileCamera::kFree && t.camera != FreeCamera{}) {
    return fmt::format("tile {} has view {}: camera is a setting of view free", t.name,
                       nameOf(t.view));
  }
  if (t.view == TileCamera::kWall) return std::nullopt;
  if (t.kind == TileKind::kOperator) {
    return fmt::format(
        "tile {} is the operator's, which sees the whole model from the front: view "
        "{} is for tiles of kind wall",
        t.name, nameOf(t.view));
  }
  if (t.turns != 0 || t.hasDirection() || t.hasFrustum() || t.hasScreen()) {
    return fmt::format(
        "tile {} has view {}, a camera of its own: leave out turns, direction_deg, "
        "frustum_deg and screen_m, or set view to wall",
        t.name, nameOf(t.view));
  }
  return t.view == TileCamera::kFree ? faultOfFreeCamera(t.name, t.camera) : std::nullopt;
}

namespace {

std::optional<std::string> faultOfTile(const TileSettings& t, const TilesSettings& s) {
  if (t.x < 0 || t.y < 0 || t.x > s.frame_width - widthOf(t, s) ||
      t.y > s.frame_height - heightOf(t, s)) {
    return fmt::format("tile {} at {}, {} does not lie in the frame of {} x {}", t.name, t.x, t.y,
                       s.frame_width, s.frame_height);
  }
  if (!std::isfinite(t.turns))
    return fmt::format("tile {}: turns is {}; it must be a finite number", t.name, t.turns);
  if (t.width < 0 || t.height < 0)
    return fmt::format("tile {} of {} x {} pixels is empty", t.name, t.width, t.height);
  if (t.view != TileCamera::kWall || t.camera != FreeCamera{}) return faultOfView(t);
  const bool own = t.hasDirection() || t.hasFrustum() || t.hasScreen();
  if (own && t.kind == TileKind::kOperator) {
    return fmt::format(
        "tile {} is the operator's, which sees the whole model: direction_deg, "
        "frustum_deg and screen_m are for tiles of kind wall",
        t.name);
  }
  if (t.hasScreen() && (t.hasDirection() || t.hasFrustum())) {
    return fmt::format(
        "tile {} has screen_m, from which its direction and frustum follow: leave "
        "out direction_deg and frustum_deg",
        t.name);
  }
  if (!allFinite(t.direction_deg))
    return fmt::format("tile {}: direction_deg contains a value that is not a number", t.name);
  if (t.hasFrustum()) return faultOfFrustum(t);
  return t.hasScreen() ? faultOfScreen(t, s) : std::nullopt;
}

SettingFaults faultsOfFigures(const TilesSettings& s) {
  SettingFaults faults;
  if (!(s.field_of_view_deg >= 1 && s.field_of_view_deg <= 179)) {
    faults.push_back(
        {"/field_of_view_deg",
         fmt::format("a field of view of {} degrees is not 1 to 179", s.field_of_view_deg)});
  }
  if (!(s.near_m > 0 && s.far_m > s.near_m && std::isfinite(s.far_m))) {
    faults.push_back(
        {"", fmt::format("near_m is {} and far_m is {}; they must satisfy 0 < near_m < far_m",
                         s.near_m, s.far_m)});
  }
  if (s.tile_width <= 0 || s.tile_height <= 0) {
    faults.push_back(
        {"", fmt::format("a tile of {} x {} pixels is empty", s.tile_width, s.tile_height)});
  }
  if (s.tiles.empty()) faults.push_back({"/tiles", "a wall has at least one tile"});
  if (s.tiles.size() > kMostTiles) {
    faults.push_back(
        {"/tiles", fmt::format("{} tiles; a wall has {} at most", s.tiles.size(), kMostTiles)});
  }
  return faults;
}

}  // namespace

SettingFaults validate(const TilesSettings& s) {
  SettingFaults faults = faultsOfFigures(s);
  if (!faults.empty()) return faults;  // further faults would only follow from these
  for (std::size_t i = 0; i < s.tiles.size(); ++i) {
    const std::string at = fmt::format("/tiles/{}", i);
    auto fault = faultOfTile(s.tiles[i], s);
    for (std::size_t j = 0; j < i && !fault; ++j) fault = faultOfPair(s.tiles[j], s.tiles[i], s);
    if (fault) faults.push_back({at, *std::move(fault)});
  }
  return faults;
}

}  // namespace merlin::render::tiles
