// Reduces the delay that a USB adapter adds to a serial line.
#pragma once

#include <string>

namespace merlin::io {

// Asks the driver of an open serial line to hand bytes on at once (ASYNC_LOW_LATENCY, which sets an
// FTDI adapter's latency timer to 1 ms; it is lost when the adapter is plugged in anew). Lines that
// do not know it are left as they are.
void askForLowLatency(int fd);

// A sentence where the adapter of `path` ("/dev/ttyUSB0", or a link to it) holds bytes back for
// longer than 1 ms, with the way out; empty where it does not, or does not say. `sysfs` is "/sys"
// but in tests.
std::string adapterWarning(const std::string& path, const std::string& sysfs = "/sys");

}  // namespace merlin::io
