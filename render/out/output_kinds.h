// The table of output kinds.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/watched_thread.h"
#include "render/out/output.h"
#include "render/out/settings.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

// Parts that outputs are made of, beside their settings.
struct OutputParts {
  const TilePlan& plan;
  std::string frame_name;        // of the frame in shared memory, as "/merlin-framebuffer"
  std::uint64_t generation = 0;  // new at each start of the daemon
  ThreadWatch& watch;            // of the outputs' own threads; outlives them, as `clock` does
  const Clock& clock;
};

// Errors: why an output of that kind cannot be made, as its class says.
Result<std::unique_ptr<Output>> makeOutput(const OutputSettings& settings,
                                           const OutputParts& parts);

}  // namespace merlin::render
