// The part of describe() that covers stereo (/wall/stereo), and "view" and "camera", with which a
// tile or a display shows another view than the wall's.
#pragma once

#include "config/visitor.h"
#include "render/stereo/settings.h"
#include "render/tiles/settings.h"

namespace merlin {

void describeView(render::tiles::TileCamera& view, render::tiles::FreeCamera& camera,
                  SettingsVisitor& visitor);
// `from_room`: a room is given, which determines the distance of each screen.
void describeStereo(render::stereo::StereoSettings& stereo, bool from_room,
                    SettingsVisitor& visitor);

}  // namespace merlin
