// Settings of a room: the panels of its wall, the displays or projectors on them, and the viewer.
//
// Room axes: x right, y up, z towards the viewer who faces the wall. The origin is any point from
// which positions are measured.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/tiles/settings.h"

namespace merlin::render::room {

inline constexpr std::size_t kMostPanels = tiles::kMostTiles;

// Maximum length of a tile's name; status and shared memory have room for this many characters.
inline constexpr std::size_t kLongestDisplayName = 15;

// Name of the operator's tile of a room.
inline constexpr const char* kOperatorTile = "operator";

// In the order of kRoomPresetNames.
enum class RoomPreset { kNone, kFlat, kThree160, kThree120, kSix, kHexagon, kArc160, kArc120 };
inline constexpr const char* kRoomPresetNames[] = {"none", "flat",    "three_160", "three_120",
                                                   "six",  "hexagon", "arc_160",   "arc_120"};
inline constexpr const char* nameOf(RoomPreset preset) {
  return kRoomPresetNames[static_cast<int>(preset)];
}

// A common wall of equal panels with one display each; see render/room/presets.h. The middle of its
// front panel, or of the seam at its front, is straight ahead of the room's origin.
struct RoomPresetSettings {
  RoomPreset name = RoomPreset::kNone;
  int panels = 0;  // preset flat: panels in the row, 0: three; fixed in other presets
  double panel_width_m = 1.6, panel_height_m = 1.2;
  double distance_m = 0;  // from the room's origin to the front panel; 0: the preset's default
  double bezel_m = 0;     // width of each display's bezel, within its panel
  // Presets flat and six: width of the strip that neighbouring projectors both show. The wall keeps
  // the size of its panels, and all pictures have the same size.
  double overlap_m = 0;
  int width = 0, height = 0;  // of each display [px]; 0: default of the tiles

  bool operator==(const RoomPresetSettings&) const = default;
};

// A flat rectangle on which displays are mounted or onto which projectors project. It is hinged to
// the panel before it in the list, or has its own position.
struct PanelSettings {
  std::string name;
  double width_m = 0, height_m = 0;
  // Angle between this panel and its left neighbour, on the viewer's side: 180 if both are in one
  // plane. This panel's lower left corner is the neighbour's lower right one. 0: not hinged
  // [degrees].
  double hinge_deg = 0;
  // If not hinged: position of the lower left corner as seen by the viewer.
  std::array<double, 3> lower_left_m{};
  // If not hinged: direction in which a viewer in front of the panel looks at it: yaw to the left,
  // then pitch upwards [degrees].
  double yaw_deg = 0, pitch_deg = 0;

  bool operator==(const PanelSettings&) const = default;
};

// A display or a projector: it becomes one tile of the wall.
struct DisplaySettings {
  std::string name;
  std::string panel;  // name of its panel; may be empty if there is only one
  // Part of the panel that it covers: distances of its left and lower edge from the panel's, width
  // and height [m]. All 0: the whole panel. Parts of different displays may overlap.
  std::array<double, 4> part_m{};
  int width = 0, height = 0;  // [px]; 0: default of the tiles
  // Bezel width on the left, right, lower and upper side: this margin of its part shows no picture,
  // and what would be seen there stays hidden, as behind a window frame [m].
  std::array<double, 4> bezel_m{};
  tiles::TileCamera view = tiles::TileCamera::kWall;  // the view that it shows
  tiles::FreeCamera camera{};                         // used if view is kFree

  bool operator==(const DisplaySettings&) const = default;
};

struct RoomSettings {
  RoomPresetSettings preset;  // alternative to panels and displays
  std::vector<PanelSettings> panels;
  std::vector<DisplaySettings> displays;            // empty: one per panel, with its name and size
  std::array<double, 3> eye_m{};                    // position of the viewer's eye
  int operator_width = 640, operator_height = 480;  // of the operator's tile [px]; 0: no tile

  bool operator==(const RoomSettings&) const = default;

  // Returns whether the configuration describes the wall as a room.
  bool isGiven() const { return *this != RoomSettings{}; }
  bool hasOperator() const { return operator_width > 0 || operator_height > 0; }
};

// Checks for: neither panels nor a preset, or both; values that are not numbers or out of range; a
// panel without a size, with both a hinge and its own position, with the name or the position of
// another, or whose front the viewer does not see; a display that exceeds its panel, has no picture
// between its bezels, has a name that is too long or taken, subtends 179 degrees or more, or has an
// invalid camera; an overlap of panels that are not in one plane; too many panels or tiles; a
// canvas that is too large. `tiles`: default sizes of displays. Pure.
SettingFaults validate(const RoomSettings& room, const tiles::TilesSettings& tiles);

}  // namespace merlin::render::room
