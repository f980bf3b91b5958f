// Records the duration of each step of the wall's frames for a trace viewer, for merlin trace and
// merlin report.
#pragma once

#include <cstddef>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::cli {

struct WallTrace {
  std::string json;  // the trace, for ui.perfetto.dev or chrome://tracing
  std::size_t frames = 0, samples = 0;
};

// Returns the trace of the last frames that cover the time `wanted`; waits for further frames if
// those in shared memory cover less. If `wanted` is 0, returns all frames in shared memory. Errors:
// kIo (no merlind shows a wall under this name), kTimeout (the wall has drawn nothing for 2 s).
Result<WallTrace> recordTrace(const std::string& instance, Duration wanted);

}  // namespace merlin::cli
