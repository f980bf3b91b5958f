// Computes the layout of the wall's picture: all tiles that follow the wall, in rows and columns as
// they are seen. Pure.
#pragma once

#include "render/tiles/tile_plan.h"

namespace merlin::render::tiles {

// Sets each tile's place in the wall's picture, and the picture's size. REQUIRES: `plan` has the
// projections and view matrices of the tiles of `settings`, in their order.
//
// Two tiles are side by side if the middle of neither is within the other's width, and one is above
// the other if the middle of neither is within the other's height. Each tile begins where the tiles
// on its left and those above it end, in whatever row or column they are. Two tiles that each have
// their middle within the other count as side by side, so that no tile covers another. A wall
// around the viewer begins behind the viewer. Tiles for the right eye are left out. Cost: quadratic
// in the number of tiles.
void layOutWall(TilePlan& plan, const TilesSettings& settings);

}  // namespace merlin::render::tiles
