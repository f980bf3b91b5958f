// Frame traces as trace-event JSON, which Perfetto and chrome://tracing show.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/shm/layout.h"

namespace merlin::cli {

// When the first byte of a sample arrived.
struct SampleInstant {
  const char* device;
  std::int64_t at_ns;
};

// Trace events, one per line of the array: each frame on the wall's track with its steps inside, a
// mark at the deadline of each late frame, the triangles as a counter, and the samples on a track
// for each device. Times count from the begin of the first frame.
std::string traceJson(std::span<const shm::FrameTrace> frames,
                      std::span<const SampleInstant> samples);

// Name of a step: "input", "scene", ...
const char* stepName(shm::StepKind kind);

}  // namespace merlin::cli
