// The part of describe() that is the room: /wall/room.
#pragma once

#include "config/visitor.h"
#include "render/room/settings.h"

namespace merlin {

void describeRoom(render::room::RoomSettings& room, SettingsVisitor& visitor);

}  // namespace merlin
