// Reduces the delay that a USB adapter adds to a serial line.
#pragma once

#include <string>

namespace merlin::io {

// Asks the driver of an open serial line to deliver bytes at once (ASYNC_LOW_LATENCY, which sets an
// FTDI adapter's latency timer to 1 ms; plugging the adapter in again resets the timer). Does
// nothing if the driver does not support it.
void askForLowLatency(int fd);

// Returns a warning, with a command that helps, if the USB adapter of `path` ("/dev/ttyUSB0", or a
// link to it) delays bytes by more than 1 ms; empty if it does not, or if its delay is unknown.
// Only tests set `sysfs`.
std::string adapterWarning(const std::string& path, const std::string& sysfs = "/sys");

}  // namespace merlin::io
