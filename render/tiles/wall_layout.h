// The wall's picture: all tiles that follow the wall, in rows and columns as they are seen. Pure.
#pragma once

#include "render/tiles/tile_plan.h"

namespace merlin::render::tiles {

// Sets each tile's place in the wall's picture, and the picture's size. REQUIRES: `plan` has the
// projections and view matrices of the tiles of `settings`, in their order.
//
// Two tiles are side by side, or one is above the other, if the middle of neither is within the
// width, or height, of the other. Then each begins where those on its left, and those above it, in
// any row or column, end. Tiles of which each has its middle within the other are side by side as
// well, so that no tile covers another. A wall around the viewer begins behind him. Tiles for the
// right eye are left out. Cost: quadratic in the number of tiles.
void layOutWall(TilePlan& plan, const TilesSettings& settings);

}  // namespace merlin::render::tiles
