// The part of describe() that is /wall.
#pragma once

#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {

void describeWall(WallSettings& wall, SettingsVisitor& visitor);

}  // namespace merlin
