// TileArrangement: the picture of an output that shows some of the wall's tiles, each at its place,
// mirrored and turned as its projector or display is mounted; in stereo, two of them as an
// anaglyph.
#pragma once

#include <vector>

#include "render/frame/correction.h"
#include "render/out/settings.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// How a placed tile lies on its output: the steps there [px] to the tile's next column and row.
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
    int x = 0, y = 0, width = 0, height = 0;  // in the canvas
    std::ptrdiff_t first = 0, column = 0, row = 0;
    // Of an anaglyph: from a pixel of the left eye's picture to the same one of the right eye's, in
    // the canvas. 0: one picture alone.
    int right_x = 0, right_y = 0;
  };
  const std::uint8_t* rowOf(const Placed& placed, int y, const out::Signal& canvas);

  int width_ = 0, height_ = 0;
  std::vector<Placed> placed_;
  std::vector<std::uint8_t> pixels_, line_;
};

}  // namespace merlin::render::frame
