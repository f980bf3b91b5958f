// Computes the tiles of a wall that is described as a room. Pure.
#pragma once

#include "daemon/base/result.h"
#include "render/room/settings.h"

namespace merlin::render::room {

// Returns settings for planTiles(): one tile of kind kWall per display, in the displays' order,
// with the corners of its picture in eye coordinates (TileSettings::screen_m) unless the display
// has a view of its own, and the operator's tile, named "operator", if the room has one. The frame
// is made large enough for all tiles.
// tiles       gives near, far, and the default size of displays; its list of tiles is replaced.
// Errors: kInvalidArgument: the first fault that validate() finds.
Result<tiles::TilesSettings> roomTiles(const RoomSettings& room, const tiles::TilesSettings& tiles);

}  // namespace merlin::render::room
