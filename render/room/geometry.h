// Positions of the panels and pictures of a room, and the angles at which the viewer sees them.
// Pure.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "render/room/settings.h"

namespace merlin::render::room {

// A rectangle in room coordinates [m].
struct Screen {
  Eigen::Vector3d corner;      // lower left, as seen by the viewer
  Eigen::Vector3d across, up;  // lower and left edge, as vectors from `corner`

  Eigen::Vector3d middle() const { return corner + (across + up) / 2; }
  // Returns the unit normal, which points to the viewer's side.
  Eigen::Vector3d normal() const;
};

// How a screen appears from a point.
struct ScreenView {
  double distance_m = 0;  // distance of the point from the screen's plane; negative behind it
  double width_deg = 0, height_deg = 0;  // between its edges; 180 if not in front of it
};

// Returns one screen per panel of a room whose panels are explicit (see withPanels()). Accepts any
// values.
std::vector<Screen> panelScreens(const RoomSettings& room);

// displayScreen() returns the part of a panel that a display covers, with its bezels;
// pictureScreen() the part between its bezels, which shows the picture.
Screen displayScreen(const DisplaySettings& display, const Screen& panel);
Screen pictureScreen(const DisplaySettings& display, const Screen& panel);

ScreenView viewFrom(const Eigen::Vector3d& eye_m, const Screen& screen);

// Returns the index of the panel that the display names, or of the only panel if the display names
// none; panels.size() if there is no such panel.
std::size_t panelOf(const DisplaySettings& display, const std::vector<PanelSettings>& panels);

inline Eigen::Vector3d pointOf(const std::array<double, 3>& metres) {
  return {metres[0], metres[1], metres[2]};
}

}  // namespace merlin::render::room
