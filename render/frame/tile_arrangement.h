// TileArrangement: the picture of an output that shows some of the wall's tiles, each at its place,
// mirrored and turned as its projector or display is mounted.
#pragma once

#include <vector>

#include "render/frame/correction.h"
#include "render/out/settings.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

// Thread-bound to the wall's thread. Costs a copy of the tiles' pixels per frame.
class TileArrangement final : public Correction {
 public:
  // REQUIRES: validate() of the output's settings found nothing.
  TileArrangement(const TilePlan& plan, const std::vector<PlacedTile>& tiles);

  // Pixels without a tile are black and opaque.
  Signal apply(const Signal& canvas) override;

 private:
  // Where a tile's upper left pixel goes, and how far its next column and row are from it [pixels].
  struct Placed {
    int x, y, width, height;  // in the canvas
    std::ptrdiff_t first, column, row;
  };

  int width_ = 0, height_ = 0;
  std::vector<Placed> placed_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace merlin::render
