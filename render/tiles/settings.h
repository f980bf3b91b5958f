// Settings of the wall's geometry.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin::render::tiles {

// Maximum number of tiles; the shared-memory framebuffer has room for this many.
inline constexpr std::size_t kMostTiles = 32;

// Maximum width and height of the frame [px].
inline constexpr int kLargestFrame_px = 16384;

enum class TileKind {
  kWall,      // a piece of the picture on the wall
  kOperator,  // the operator's own view of the whole model
};

// Whose view a tile of kind kWall shows. In the order of kTileCameraNames.
enum class TileCamera {
  kWall,   // a part of the wall's view, as seen from its eye
  kTop,    // the whole content from above, in parallel projection
  kSide,   // the whole content from the right, in parallel projection
  kFront,  // the whole content from the front, in parallel projection
  kFree,   // the view of a FreeCamera
};
inline constexpr const char* kTileCameraNames[] = {"wall", "top", "side", "front", "free"};
inline constexpr const char* nameOf(TileCamera camera) {
  return kTileCameraNames[static_cast<int>(camera)];
}

// The camera of a tile with view kFree. Positions are in eye coordinates of the wall (x right, y
// up, z towards the viewer) [m].
struct FreeCamera {
  std::array<double, 3> eye_m{};
  std::array<double, 3> look_at_m{0, 0, -2};  // position in the middle of its picture
  std::array<double, 3> up{0, 1, 0};          // direction that is upwards in its picture
  double field_of_view_deg = 40;              // horizontal

  bool operator==(const FreeCamera&) const = default;
};

// Which of the viewer's eyes a tile is drawn for. Without stereo all tiles are drawn for kMiddle,
// the middle between the eyes.
enum class Eye { kMiddle, kLeft, kRight };

// By default, the direction of a tile follows from `turns` and its field of view is that of all
// tiles. direction_deg, frustum_deg and screen_m change this, for tiles of kind kWall only.
struct TileSettings {
  std::string name;
  TileKind kind = TileKind::kWall;
  int x = 0, y = 0;           // upper left corner in the frame [px]
  double turns = 0;           // yaw in units of field_of_view_deg; +1: to the left
  int width = 0, height = 0;  // [px]; 0: TilesSettings::tile_width and tile_height
  // Direction relative to that of `turns`: yaw to the left, then pitch upwards, then roll
  // counter-clockwise as seen by the viewer [degrees].
  std::array<double, 3> direction_deg{};
  // Angles of the left, right, lower and upper edge from the tile's direction, positive to the
  // right and upwards [degrees]. All 0: symmetric, with the field of view of all tiles.
  std::array<double, 4> frustum_deg{};
  // Positions of the lower left, lower right and upper left corner of the tile's screen in eye
  // coordinates (x right, y up, z towards the viewer) [m]; direction and frustum follow from them.
  // All 0: no screen.
  std::array<double, 9> screen_m{};
  TileCamera view = TileCamera::kWall;
  FreeCamera camera{};  // used if view is kFree
  // The eye that the tile is drawn for; only render/stereo sets another one.
  Eye eye = Eye::kMiddle;

  // Returns whether the tile shows a part of the wall's view.
  bool followsWall() const { return kind == TileKind::kWall && view == TileCamera::kWall; }
  bool hasFrustum() const { return frustum_deg != std::array<double, 4>{}; }
  bool hasScreen() const { return screen_m != std::array<double, 9>{}; }
  bool hasDirection() const { return direction_deg != std::array<double, 3>{}; }
};

struct TilesSettings {
  int tile_width = 640, tile_height = 480;     // [px]
  int frame_width = 1280, frame_height = 960;  // [px]
  double field_of_view_deg = 40;               // horizontal, of one tile
  double near_m = 0.05, far_m = 50;            // clipping planes
  // [GOURLEY98] figure 2.15: upper left, upper right, lower left, lower right.
  std::vector<TileSettings> tiles = {{"left", TileKind::kWall, 0, 0, 1},
                                     {"centre", TileKind::kWall, 640, 0, 0},
                                     {"right", TileKind::kWall, 0, 480, -1},
                                     {"operator", TileKind::kOperator, 640, 480, 0}};
  // Vector from the left eye to the right eye while the head is held straight (x right, y up, z
  // towards the person) [m].
  std::array<double, 3> eyes_m{};
};

// Returns a fault of a tile's own view (any other than kWall) or of its camera: the tile is the
// operator's, it has turns, a direction, a frustum or a screen as well, the camera is set without
// view kFree, or it is invalid. Nothing if there is no fault. Pure.
std::optional<std::string> faultOfView(const TileSettings& tile);

// Checks for: a tile outside the frame; two tiles that overlap in the frame (their views may
// overlap); two tiles with one name; two tiles with the same direction by `turns` alone; no tile or
// more than kMostTiles; a field of view outside 1..179 degrees; an invalid frustum; a screen that
// is not a rectangle, is not seen from its front by the tile's eye or subtends 179 degrees or more;
// an invalid view of its own; near or far out of order; a tile without pixels; values that are not
// finite numbers. Pure.
SettingFaults validate(const TilesSettings& settings);

}  // namespace merlin::render::tiles
