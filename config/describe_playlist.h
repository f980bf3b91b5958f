// The part of describe() (config/visitor.h) that covers /wall/playlist.
#pragma once

#include "config/visitor.h"
#include "daemon/wall/settings.h"

namespace merlin {

void describePlaylist(PlaylistSettings& playlist, SettingsVisitor& v);

}  // namespace merlin
