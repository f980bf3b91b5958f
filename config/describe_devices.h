// The parts of describe() that are about input: /devices, /hands, /postures, /bindings, /people,
// /gpio, the projectors, and what concerns all devices.
#pragma once

#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {

void describeDevices(DevicesSettings& devices, SettingsVisitor& visitor);

}  // namespace merlin
