// Creates outputs from their settings, by the table of output kinds.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "daemon/base/panel_pointer.h"
#include "daemon/base/watched_thread.h"
#include "render/out/kms_output.h"
#include "render/out/output.h"
#include "render/out/settings.h"
#include "render/out/window/window_link.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::out {

// What outputs need besides their settings.
struct OutputParts {
  const tiles::TilePlan& plan;
  std::string frame_name;        // name of the shared-memory object, e.g. "/merlin-framebuffer"
  std::uint64_t generation = 0;  // number that is new at each start of the daemon
  ThreadWatch& watch;  // watches the outputs' own threads; `watch` and `clock` outlive the outputs
  const Clock& clock;
  const tiles::TilesSettings& tiles;
  kms::Cards& cards;    // for outputs of kind kms
  WindowActs window{};  // for outputs of kind window
  // Where the operator's panel is in the frame, for the outputs' mouse pointers; nothing: no panel.
  std::optional<PanelPointer::Place> panel{};
};

// Returns where the picture of an output with these settings shows the operator's panel; nothing if
// it does not show it, or shows it mirrored or rotated. `in_frame`: the panel's place in the frame.
std::optional<PanelPointer::Place> panelIn(const OutputSettings& settings,
                                           const tiles::TilePlan& plan,
                                           const PanelPointer::Place& in_frame);

// Checks that this installation has what outputs of this kind need. Errors: kUnsupported: what is
// missing, and how to get it.
Result<Ok> checkIsThere(OutputKind kind);

// Makes the output that `settings` describes. Errors: kUnsupported: its kind needs something that
// this installation lacks; kind shared_memory: those of SharedFrameOutput::make().
Result<std::unique_ptr<Output>> makeOutput(const OutputSettings& settings,
                                           const OutputParts& parts);

}  // namespace merlin::render::out
