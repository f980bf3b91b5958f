// DrawPlace: where a GPU may draw the next picture of a display, instead of the picture being
// copied there.
#pragma once

#include <memory>

#include "daemon/base/dma_buf.h"

namespace merlin::render::out {

struct DrawPlace {
  // The memory to draw into; the same memory is always the same object. It is shared, so that an
  // importer notices when nobody else uses it any more. Null: the card's driver does not share its
  // memory.
  std::shared_ptr<const DmaBuf> buffer{};
  int x = 0, y = 0;  // [px] where the picture's upper left pixel is in the buffer
};

}  // namespace merlin::render::out
