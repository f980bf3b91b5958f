// The panel's lines on a GPIO chip, through libgpiod (version 1 of its interface, Debian 12's).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/port/gpio_line.h"

namespace merlin::io {

// `chip`: "gpiochip0" or "/dev/gpiochip0". Line numbers of -1 are left out. Outputs start low; the
// input has both edges. Errors: kNotFound (no such chip), kBusy (another program holds a line),
// kIo (a missing permission names the group), kInvalidArgument (no such line).
Result<std::unique_ptr<GpioLines>> openGpioChip(const std::string& chip,
                                                const std::vector<int>& outputs, int input);

}  // namespace merlin::io
