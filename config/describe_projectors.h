// The part of describe() (config/visitor.h) that covers /projectors and /projector_schedule.
#pragma once

#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {

void describeProjectors(DevicesSettings& devices, SettingsVisitor& visitor);

}  // namespace merlin
