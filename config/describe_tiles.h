// The part of describe() (config/visitor.h) that covers /wall/tiles.
#pragma once

#include "config/visitor.h"
#include "render/tiles/settings.h"

namespace merlin {

// `from_room`: whether the configuration has a room, from which the frame and the tiles are then
// computed, so that their settings are not allowed.
void describeTiles(render::tiles::TilesSettings& tiles, bool from_room, SettingsVisitor& visitor);

}  // namespace merlin
