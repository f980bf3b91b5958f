// The part of describe() (config/visitor.h) that covers /wall/shown.
#pragma once

#include "config/visitor.h"
#include "daemon/wall/settings.h"

namespace merlin {

void describeShown(ShownSettings& shown, SettingsVisitor& v);

}  // namespace merlin
