// Settings of the wall's geometry.
#pragma once

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

struct TileSettings {
  std::string name;
  TileKind kind = TileKind::kWall;
  int x = 0, y = 0;  // of its upper left corner in the frame buffer [px]
  double turns = 0;  // about the vertical axis, in tile widths; +1 is one to the left
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

// Everything that no wall can be made of: a tile outside the frame, two that overlap, two of one
// name or turn, no tile or more than kMostTiles, a field of view that is not 1..179 degrees, near
// or far out of order, a tile without pixels, figures that are no numbers. Pure.
SettingFaults validate(const TilesSettings& settings);

}  // namespace merlin::render
