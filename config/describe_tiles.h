// The part of describe() that is /wall/tiles.
#pragma once

#include "config/visitor.h"
#include "render/tiles/settings.h"

namespace merlin {

// `from_room`: a room is given, from which the frame and the tiles are computed.
void describeTiles(render::tiles::TilesSettings& tiles, bool from_room, SettingsVisitor& visitor);

}  // namespace merlin
