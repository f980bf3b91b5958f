// How long idle cores may take to wake, which is most of what a byte waits for on a quiet machine.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::io {

// From now on and until the descriptor is closed, by its process's end too, no idle core sleeps so
// deeply that it takes longer than `microseconds` to wake; 0: none sleeps at all. For the whole
// machine; the strictest of all that ask counts (the kernel's CPU latency quality of service). It
// costs power. Errors: kNotFound, kIo, each with the way out. `device` is the default but
// in tests. REQUIRES: microseconds >= 0.
Result<UniqueFd> limitCpuLatency(int microseconds,
                                 const std::string& device = "/dev/cpu_dma_latency");

}  // namespace merlin::io
