// The parts of describe() (config/visitor.h) that cover /wall/stereo, and the settings "view" and
// "camera", which give a tile or a display its own view of the model.
#pragma once

#include "config/visitor.h"
#include "render/stereo/settings.h"
#include "render/tiles/settings.h"

namespace merlin {

void describeView(render::tiles::TileCamera& view, render::tiles::FreeCamera& camera,
                  SettingsVisitor& visitor);
// `from_room`: whether the configuration has a room, which then determines the distance of each
// screen.
void describeStereo(render::stereo::StereoSettings& stereo, bool from_room,
                    SettingsVisitor& visitor);

}  // namespace merlin
