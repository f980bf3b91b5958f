// Where frames' time went, as the trace-event JSON that Perfetto and chrome://tracing show.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/shm/layout.h"

namespace merlin::cli {

// When a sample's first byte came.
struct SampleInstant {
  const char* device;
  std::int64_t at_ns;
};

// One event an entry: each frame on the wall's track with its steps inside, a mark where one was
// late, the triangles as a counter, and samples on a track of each device's. Times count from the
// first frame.
std::string traceJson(std::span<const shm::FrameTrace> frames,
                      std::span<const SampleInstant> samples);

// As design's "one frame" calls it: "input", "scene", ...
const char* stepName(shm::StepKind kind);

}  // namespace merlin::cli
