// Draws the plates of the operator's tile: one with the wall's state, and one with messages. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "render/text/operator_facts.h"
#include "render/text/surface.h"
#include "render/text/text.h"

namespace merlin::render::text {

// A picture to be blended over a tile's picture: premultiplied RGBA, rows from top to bottom.
struct Plate {
  Rect at;  // in the tile; not empty
  std::vector<std::uint8_t> rgba;
};

struct PlateFonts {
  Font text, heading;
};

// A smaller tile has no plates, since they would hide all of it.
inline constexpr int kLeastTileWidth_px = 320, kLeastTileHeight_px = 240;

// Returns the em size of text on a tile of this height [px].
int textSizeFor(int tile_height_px) noexcept;
int headingSizeFor(int tile_height_px) noexcept;

// Draws all plates; the same facts give the same bytes. `tile`: only its size is used. Costs about
// as much as filling the plates twice.
std::vector<Plate> drawPlates(const OperatorFacts& facts, const PlateFonts& fonts,
                              const Rect& tile);

}  // namespace merlin::render::text
