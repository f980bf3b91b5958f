// The wall as it is drawn: what its settings become in stereo.
#pragma once

#include "config/settings.h"

namespace merlin {

// The same wall with the tiles of both eyes, and outputs that show them; without stereo and without
// a tracked head, as it was. REQUIRES: loadSettings() found nothing.
WallSettings drawnWall(const WallSettings& wall);

}  // namespace merlin
