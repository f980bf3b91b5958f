#include "render/room/geometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "daemon/base/radian.h"

namespace merlin::render::room {
namespace {

Eigen::Matrix3d yaw(double degrees) {
  return Eigen::AngleAxisd(degrees * kRadian<double>, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

Eigen::Matrix3d pitch(double degrees) {
  return Eigen::AngleAxisd(degrees * kRadian<double>, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

// Returns a part of a screen. `part_m`: distances of its left and lower edge from the screen's,
// width and height [m].
Screen partOf(const Screen& screen, const std::array<double, 4>& part_m) {
  const Eigen::Vector3d right = screen.across.normalized(), up = screen.up.normalized();
  return {screen.corner + part_m[0] * right + part_m[1] * up, part_m[2] * right, part_m[3] * up};
}

}  // namespace

Eigen::Vector3d Screen::normal() const { return across.cross(up).normalized(); }

std::vector<Screen> panelScreens(const RoomSettings& room) {
  std::vector<Screen> screens;
  Eigen::Matrix3d T_room_panel = Eigen::Matrix3d::Identity();
  for (const PanelSettings& p : room.panels) {
    const bool hinged = p.hinge_deg != 0 && !screens.empty();
    // A hinge rotates a panel about the edge that it shares with its left neighbour.
    T_room_panel = hinged ? Eigen::Matrix3d(T_room_panel * yaw(p.hinge_deg - 180))
                          : Eigen::Matrix3d(yaw(p.yaw_deg) * pitch(p.pitch_deg));
    const Eigen::Vector3d corner =
        hinged ? Eigen::Vector3d(screens.back().corner + screens.back().across)
               : pointOf(p.lower_left_m);
    screens.push_back({corner, p.width_m * T_room_panel.col(0), p.height_m * T_room_panel.col(1)});
  }
  return screens;
}

Screen displayScreen(const DisplaySettings& display, const Screen& panel) {
  return display.part_m == std::array<double, 4>{} ? panel : partOf(panel, display.part_m);
}

Screen pictureScreen(const DisplaySettings& display, const Screen& panel) {
  const Screen whole = displayScreen(display, panel);
  const auto& [left, right, lower, upper] = display.bezel_m;
  return partOf(whole,
                {left, lower, whole.across.norm() - left - right, whole.up.norm() - lower - upper});
}

ScreenView viewFrom(const Eigen::Vector3d& eye_m, const Screen& screen) {
  ScreenView view{screen.normal().dot(eye_m - screen.corner), 180, 180};
  if (!(view.distance_m > 0)) return view;
  const auto angle = [&](const Eigen::Vector3d& edge) {
    const double low = edge.normalized().dot(screen.corner - eye_m);
    return (std::atan2(low + edge.norm(), view.distance_m) - std::atan2(low, view.distance_m)) /
           kRadian<double>;
  };
  view.width_deg = angle(screen.across);
  view.height_deg = angle(screen.up);
  return view;
}

std::size_t panelOf(const DisplaySettings& display, const std::vector<PanelSettings>& panels) {
  if (display.panel.empty() && panels.size() == 1) return 0;
  const auto found = std::ranges::find(panels, display.panel, &PanelSettings::name);
  return static_cast<std::size_t>(found - panels.begin());
}

}  // namespace merlin::render::room
