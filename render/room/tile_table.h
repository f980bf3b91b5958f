// The figures of a wall's tiles that its builder checks: field of view, size, pixel pitch. Pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render/tiles/tile_plan.h"

namespace merlin::render::room {

// Figures of a tile whose screen has known corners (TileSettings::screen_m).
struct ScreenFigures {
  double width_m = 0, height_m = 0;
  std::array<double, 2> pixel_pitch_mm{};  // horizontal and vertical
  double distance_m = 0;                   // from the eye to the middle of the screen
};

struct TileFigures {
  std::string name;
  tiles::TileKind kind = tiles::TileKind::kWall;
  int x = 0, y = 0, width = 0, height = 0;      // in the frame [px]
  double horizontal_deg = 0, vertical_deg = 0;  // field of view; 0: parallel projection
  double yaw_deg = 0, pitch_deg = 0;  // direction of the tile's middle; left and up are positive
  std::optional<ScreenFigures> screen = std::nullopt;  // none: the tile has no screen
  tiles::TileCamera view = tiles::TileCamera::kWall;

  bool followsWall() const {
    return kind == tiles::TileKind::kWall && view == tiles::TileCamera::kWall;
  }
  // Returns what the tile shows: "wall", "operator", or the name of its own view.
  const char* shows() const {
    return kind == tiles::TileKind::kOperator ? "operator" : nameOf(view);
  }
};

// Returns one entry per tile, in the order of the tiles. REQUIRES: `plan` is planTiles(settings).
std::vector<TileFigures> tileTable(const tiles::TilesSettings& settings,
                                   const tiles::TilePlan& plan);

// Two tiles that show the same part of the same plane, e.g. projectors with overlapping pictures.
struct TileOverlap {
  std::string left, right;           // names of the tiles
  double width_m = 0, height_m = 0;  // size of the common part
  // Size of the common part in the pixels of each tile, across and down.
  std::array<int, 2> left_px{}, right_px{};
};

// Returns the overlaps between tiles of the same eye on one plane (planeParts() of render/tiles)
// that are at least a millimetre wide and high.
std::vector<TileOverlap> tileOverlaps(const tiles::TilePlan& plan);

// cornersOf() returns the corners of a tile's picture in eye coordinates [m], counter-clockwise
// from the lower left: those of its screen; without a screen, those at `distance_m` along its
// direction.
using Corners = std::array<std::array<double, 3>, 4>;
Corners cornersOf(const tiles::TileSettings& settings, const tiles::Tile& tile, double distance_m);

}  // namespace merlin::render::room
