// Converts frame traces to JSON in the trace-event format of Perfetto and chrome://tracing.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/shm/layout.h"

namespace merlin::cli {

// The time at which the first byte of a sample arrived.
struct SampleInstant {
  std::string device;  // name of the device
  std::int64_t at_ns;
};

// Returns the trace events as JSON: each frame on the track of the wall with its steps inside, an
// instant event at the deadline of each late frame, each frame's cost (such as its number of
// triangles) as a counter, and the samples on one track per device. Times are relative to the
// beginning of the first frame.
std::string traceJson(std::span<const shm::FrameTrace> frames,
                      std::span<const SampleInstant> samples);

// Returns the name of a step: "input", "scene", ...
const char* stepName(shm::StepKind kind);

}  // namespace merlin::cli
