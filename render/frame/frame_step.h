// FrameStep: where a frame renderer's time went, for the trace.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"

namespace merlin::render {

struct FrameStep {
  enum class Kind {
    kChoose,    // what of the content all views show: a model's cut
    kUpload,    // what was chosen, to one context
    kDraw,      // one tile
    kReadBack,  // one tile's pixels
    kRefine,    // a slice of a finer frame
  };
  Kind kind = Kind::kDraw;
  std::uint16_t tile = 0;  // number in the tile plan, of kDraw and kReadBack
  Timestamp begin{}, end{};
};

}  // namespace merlin::render
