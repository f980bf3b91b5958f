// Finds the tiles that lie on one plane, such as projectors whose pictures overlap on one screen,
// and which part of the plane each shows. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "render/tiles/tile_plan.h"

namespace merlin::render::tiles {

// The part of a plane that a tile shows, from the plane's upper left corner [m]. The plane is the
// smallest rectangle around all tiles on it.
struct PlanePart {
  std::size_t plane = 0;  // tiles of the same plane have the same number
  double left = 0, top = 0, width = 0, height = 0;
  double plane_width = 0, plane_height = 0;
};

// Returns one entry for each tile of the plan; nothing for a tile without a screen
// (Tile::screen_m). Tiles are on one plane if their screens are, within a millimetre, with the same
// directions across and up.
std::vector<std::optional<PlanePart>> planeParts(const TilePlan& plan);

// Widths of the strips at a tile's borders that another tile of the same plane and eye shows as
// well [m].
struct SharedStrips {
  double left = 0, right = 0, top = 0, bottom = 0;
};

// Returns one entry for each tile of the plan. REQUIRES: `parts` is planeParts(plan).
std::vector<SharedStrips> sharedStrips(const TilePlan& plan,
                                       const std::vector<std::optional<PlanePart>>& parts);

}  // namespace merlin::render::tiles
