// Draws the wall from above as SVG, with the table of its tiles.
#pragma once

#include <string>
#include <vector>

#include "render/room/settings.h"
#include "render/room/tile_table.h"
#include "render/tiles/tile_plan.h"

namespace merlin::cli {

struct WallPlan {
  render::room::RoomSettings room;  // with its panels; without panels if the tiles are set by hand
  render::tiles::TilesSettings tiles;
  render::tiles::TilePlan plan;  // the plan that follows from `tiles`
  double wall_distance_m = 2;    // distance from the eye at which tiles without a screen are drawn
};

// Returns the table as lines of text: a heading, a line for each tile, then the overlaps of the
// tiles.
std::vector<std::string> tableLines(const WallPlan& wall);

// Returns an SVG drawing of panels, displays, frusta and the eye from above, with angles and a
// scale; the table is below.
std::string planSvg(const WallPlan& wall);

}  // namespace merlin::cli
