// The part of describe() (config/visitor.h) that covers input: /devices, /hands, /postures,
// /gestures, /bindings, /people, /gpio, /projectors, /projector_schedule, /cpu_latency_us and
// /script.
#pragma once

#include "config/settings.h"
#include "config/visitor.h"

namespace merlin {

void describeDevices(DevicesSettings& devices, SettingsVisitor& visitor);

}  // namespace merlin
