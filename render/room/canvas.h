// Arranges tiles in a frame that is as small as possible. Pure.
#pragma once

#include <vector>

#include "render/tiles/settings.h"

namespace merlin::render::room {

struct CanvasSize {
  int width = 0, height = 0;  // [px]
  bool isTooLarge() const {
    return width > tiles::kLargestFrame_px || height > tiles::kLargestFrame_px;
  }
};

// Sets x and y of every tile, whose width and height must be set, so that no tiles overlap, and
// returns the size of the frame. Tiles are put in rows, taller tiles first, otherwise in their
// order. Among the row lengths whose frame area is at most 25 % above the smallest, chooses the one
// with the shortest longer side of the frame; chooses a frame that is too large only if every row
// length gives one. Cost: quadratic in the number of tiles.
CanvasSize placeOnCanvas(std::vector<tiles::TileSettings>& tiles);

}  // namespace merlin::render::room
