// Converts the settings of a wall to those by which it is drawn, with tiles and outputs for both
// eyes in stereo.
#pragma once

#include "config/settings.h"

namespace merlin {

// Returns the wall with the tiles of both eyes and the outputs that show them. A wall without
// stereo and without a tracked head is returned unchanged. REQUIRES: loadSettings() found no fault.
WallSettings drawnWall(const WallSettings& wall);

}  // namespace merlin
