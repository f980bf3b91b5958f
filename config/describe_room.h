// The part of describe() (config/visitor.h) that covers /wall/room.
#pragma once

#include "config/visitor.h"
#include "render/room/settings.h"

namespace merlin {

void describeRoom(render::room::RoomSettings& room, SettingsVisitor& visitor);

}  // namespace merlin
