// Opens the panel's lines on a GPIO chip by libgpiod (version 1 of its API, as in Debian 12).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/port/gpio_line.h"

namespace merlin::io {

// `chip`: "gpiochip0", "/dev/gpiochip0" or its label. Line numbers of -1 are skipped. Outputs start
// low; the input reports both edges. Errors: kNotFound (no such chip; the message lists the chips),
// kBusy (another program holds a line; the message names it), kIo (if permission is missing, the
// message names the group to join), kInvalidArgument (no such line).
Result<std::unique_ptr<GpioLines>> openGpioChip(const std::string& chip,
                                                const std::vector<int>& outputs, int input);

}  // namespace merlin::io
