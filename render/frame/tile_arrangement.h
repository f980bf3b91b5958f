// TileArrangement: the picture of an output that shows some of the wall's tiles, each at its place,
// mirrored and rotated as its projector or display is mounted; in stereo, two of them as an
// anaglyph.
#pragma once

#include <vector>

#include "render/frame/correction.h"
#include "render/out/settings.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// How a placed tile is oriented on its output: the steps in the output's picture [px] that lead
// from a pixel of the tile to its next column and to its next row.
struct TileAxes {
  struct Step {
    int x = 0, y = 0;
  };
  Step column{1, 0}, row{0, 1};
};
TileAxes axesOf(const out::PlacedTile& placed);

// Thread-bound to the wall's thread. Cost: one copy of the tiles' pixels per frame.
class TileArrangement final : public Correction {
 public:
  // REQUIRES: validate() of the output's settings found nothing.
  TileArrangement(const tiles::TilePlan& plan, const std::vector<out::PlacedTile>& tiles);

  // Pixels that no tile covers are black and opaque.
  out::Signal apply(const out::Signal& canvas) override;

 private:
  // `first`: index in the output's picture of the tile's upper left pixel; `column`, `row`: index
  // steps from there to the tile's next column and row [pixels].
  struct Placed {
    int x = 0, y = 0, width = 0, height = 0;  // the tile's rectangle in the canvas [px]
    std::ptrdiff_t first = 0, column = 0, row = 0;
    // For an anaglyph: offset in the canvas [px] from a pixel of the left eye's picture to the same
    // pixel of the right eye's. Both 0: no anaglyph.
    int right_x = 0, right_y = 0;
  };
  const std::uint8_t* rowOf(const Placed& placed, int y, const out::Signal& canvas);

  int width_ = 0, height_ = 0;
  std::vector<Placed> placed_;
  std::vector<std::uint8_t> pixels_, line_;
};

}  // namespace merlin::render::frame
