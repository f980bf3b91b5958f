// Settings of the wall's geometry.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin::render {

// Number of tiles that the shared-memory frame buffer has room for.
inline constexpr std::size_t kMostTiles = 32;

enum class TileKind {
  kWall,      // a piece of the picture on the wall
  kOperator,  // the operator's own view of the whole model
};

// A tile looks where `turns` says, with the field of view of all tiles, unless one of the others
// says more; only tiles of kind kWall have these.
struct TileSettings {
  std::string name;
  TileKind kind = TileKind::kWall;
  int x = 0, y = 0;           // upper left corner in the frame buffer [px]
  double turns = 0;           // about the vertical axis, in tile widths; +1 is one to the left
  int width = 0, height = 0;  // [px]; 0: those of all tiles
  // Direction relative to that of `turns`: yaw to the left, then pitch upwards, then roll
  // counter-clockwise as the viewer sees it [degrees].
  std::array<double, 3> direction_deg{};
  // Angles of the left, right, lower and upper edge from the tile's direction; left and lower ones
  // are negative. All 0: symmetric, with the field of view of all tiles.
  std::array<double, 4> frustum_deg{};
  // Lower left, lower right and upper left corner of the tile's screen as seen from the eye
  // (x right, y up, z towards the person) [m]; direction and frustum follow. All 0: none.
  std::array<double, 9> screen_m{};

  bool hasFrustum() const { return frustum_deg != std::array<double, 4>{}; }
  bool hasScreen() const { return screen_m != std::array<double, 9>{}; }
  bool hasDirection() const { return direction_deg != std::array<double, 3>{}; }
};

struct TilesSettings {
  int tile_width = 640, tile_height = 480;     // [px]
  int frame_width = 1280, frame_height = 960;  // [px]
  double field_of_view_deg = 40;               // of one tile, horizontally
  double near_m = 0.05, far_m = 50;            // what is drawn, along the view
  // [GOURLEY98] figure 2.15: upper left, upper right, lower left, lower right.
  std::vector<TileSettings> tiles = {{"left", TileKind::kWall, 0, 0, 1},
                                     {"centre", TileKind::kWall, 640, 0, 0},
                                     {"right", TileKind::kWall, 0, 480, -1},
                                     {"operator", TileKind::kOperator, 640, 480, 0}};
};

// Finds what no wall can be made of: a tile outside the frame, two that overlap in the frame (what
// they show may overlap), two of one name, two that look the same way by `turns` alone, no tile or
// more than kMostTiles, a field of view that is not 1..179 degrees, a frustum or a screen that is
// not one, near or far out of order, a tile without pixels, figures that are not numbers. Pure.
SettingFaults validate(const TilesSettings& settings);

}  // namespace merlin::render
