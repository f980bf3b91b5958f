// The part of describe() (config/visitor.h) that covers /wall.
#pragma once

#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {

void describeWall(WallSettings& wall, SettingsVisitor& visitor);

}  // namespace merlin
