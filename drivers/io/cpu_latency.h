// Limits the wake-up latency of idle processor cores, which is most of a byte's delay on a machine
// with little load.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::io {

// Until the returned descriptor is closed (also by the end of the process), no idle core enters a
// sleep state from which it needs longer than `microseconds` to wake; 0: no core sleeps at all. The
// limit applies to the whole machine and raises its power consumption; the strictest limit of all
// programs takes effect (the kernel's CPU latency quality of service). Errors: kNotFound, kIo; the
// messages say what to do. Only tests set `device`. REQUIRES: microseconds >= 0.
Result<UniqueFd> limitCpuLatency(int microseconds,
                                 const std::string& device = "/dev/cpu_dma_latency");

}  // namespace merlin::io
