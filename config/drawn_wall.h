// The wall as it is drawn: what its settings become in stereo.
#pragma once

#include "config/settings.h"

namespace merlin {

// Returns the wall with the tiles of both eyes, and outputs that show them; without stereo and
// without a tracked head, the wall is unchanged. REQUIRES: loadSettings() found no fault.
WallSettings drawnWall(const WallSettings& wall);

}  // namespace merlin
