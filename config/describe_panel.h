// The part of describe() that is /gpio.
#pragma once

#include "config/visitor.h"
#include "drivers/gpio/settings.h"

namespace merlin {

void describePanel(GpioSettings& gpio, SettingsVisitor& visitor);

}  // namespace merlin
