// The wall from above as SVG, with the table of its tiles.
#pragma once

#include <string>
#include <vector>

#include "render/room/settings.h"
#include "render/room/tile_table.h"
#include "render/tiles/tile_plan.h"

namespace merlin::cli {

struct WallPlan {
  render::room::RoomSettings room;  // with explicit panels, or none if the tiles are set by hand
  render::tiles::TilesSettings tiles;
  render::tiles::TilePlan plan;  // of `tiles`
  double wall_distance_m = 2;    // distance from the eye at which tiles without a screen are drawn
};

// The table as lines of text: a heading, a line for each tile, then its overlaps.
std::vector<std::string> tableLines(const WallPlan& wall);

// Panels, displays, frusta and the eye from above, with angles and a scale; the table below.
std::string planSvg(const WallPlan& wall);

}  // namespace merlin::cli
