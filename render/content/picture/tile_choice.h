// Chooses the tiles of a pyramid that a view needs: coarse where the picture is small in the view,
// fine where it is large. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/content/picture/surface.h"
#include "render/image/pyramid_file.h"

namespace merlin::render::content {

using Levels = std::span<const image::PyramidLevel>;

// Returns the part of the picture that a tile covers, in pixels of the finest level. The last
// column and row reach to the picture's edge, which rounding may have cut off from a coarser level.
PixelRect rectOf(Levels levels, const image::TilePlace& place);

// Returns the tile of the next coarser level that covers this tile. REQUIRES: place.level + 1 <
// levels.size().
image::TilePlace parentOf(Levels levels, const image::TilePlace& place);

// Adds the tiles that cover the part of the picture that the view may show, each once, such that
// none of their pixels is larger in the view than `pixel_px`, unless the tile is of the finest
// level. Returns false if there are more than `most`; then some are missing. O(tiles * levels).
bool chooseTiles(Levels levels, const Surface& surface, const PictureView& view, double pixel_px,
                 std::size_t most, std::vector<image::TilePlace>& tiles);

}  // namespace merlin::render::content
