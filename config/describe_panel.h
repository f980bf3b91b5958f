// The part of describe() (config/visitor.h) that covers /gpio, the control panel.
#pragma once

#include "config/visitor.h"
#include "drivers/gpio/settings.h"

namespace merlin {

void describePanel(GpioSettings& gpio, SettingsVisitor& visitor);

}  // namespace merlin
