// FrameStep: one timed step of drawing a frame, for the trace.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"

namespace merlin::render::frame {

struct FrameStep {
  enum class Kind {
    kChoose,    // selecting the content's detail for all views: a model's cut
    kUpload,    // uploading the selection to one context
    kDraw,      // drawing one tile
    kReadBack,  // reading back one tile's pixels
    kRefine,    // one call of refine()
  };
  Kind kind = Kind::kDraw;
  std::uint16_t tile = 0;  // index in the tile plan; for kDraw and kReadBack
  Timestamp begin{}, end{};
};

}  // namespace merlin::render::frame
