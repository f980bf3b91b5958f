// The parts of describe() that are views of their own and stereo: /wall/stereo, and "view" and
// "camera" of a tile or display.
#pragma once

#include "config/visitor.h"
#include "render/stereo/settings.h"
#include "render/tiles/settings.h"

namespace merlin {

void describeView(render::tiles::TileCamera& view, render::tiles::FreeCamera& camera,
                  SettingsVisitor& visitor);
// `from_room`: the room says how far away each screen is.
void describeStereo(render::stereo::StereoSettings& stereo, bool from_room,
                    SettingsVisitor& visitor);

}  // namespace merlin
