// GpioLines: interface to the lines of a GPIO chip. Implemented by drivers/io/gpio_chip (libgpiod)
// and by a fake in tests.
#pragma once

#include <functional>
#include <memory>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin {

// Thread-bound. An unused line has the number -1: writing it does nothing, reading it gives false.
class GpioLines {
 public:
  virtual ~GpioLines() = default;

  // Set or read the level of a line. Errors: kIo (the chip does not respond any more).
  virtual Result<Ok> write(int line, bool high) = 0;
  virtual Result<bool> read(int line) = 0;

  // Waits until an input may have changed, or `timeout` passes. Errors: kIo.
  virtual Result<Ok> wait(Duration timeout) = 0;
};

// Opens the chip with its lines; called again for each attempt. Errors: kNotFound, kBusy, kIo.
using GpioOpener = std::function<Result<std::unique_ptr<GpioLines>>()>;

}  // namespace merlin
