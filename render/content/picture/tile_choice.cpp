#include "render/content/picture/tile_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace merlin::render::content {
namespace {

using image::PyramidLevel;
using image::TilePlace;

const PyramidLevel& levelOf(Levels levels, const TilePlace& place) {
  return levels[static_cast<std::size_t>(place.level)];
}

// A range of tiles in one direction. finer() returns the tiles of the next finer level that a tile
// covers; the last tile takes all that are left, since a coarser level is rounded down.
struct Range {
  std::int32_t first, end;
};
Range finer(std::int32_t tile, std::int64_t tiles, std::int64_t finer_tiles) {
  const bool last = tile + 1 == tiles;
  return {2 * tile, static_cast<std::int32_t>(
                        last ? finer_tiles : std::min<std::int64_t>(2 * tile + 2, finer_tiles))};
}

class Chooser {
 public:
  Chooser(Levels levels, const Surface& surface, const PictureView& view, double pixel_px,
          std::size_t most, std::vector<TilePlace>& tiles)
      : levels_(levels),
        surface_(surface),
        view_(view),
        pixel_px_(pixel_px),
        most_(tiles.size() + most),
        tiles_(tiles) {}

  bool add(const TilePlace& place) {
    const PixelRect rect = rectOf(levels_, place);
    if (!surface_.maySee(view_, rect)) return true;
    const double size = place.level == 0 ? 0 : surface_.pixelSize(view_, rect);
    if (std::ldexp(size, place.level) > pixel_px_) return addFiner(place);
    if (tiles_.size() == most_) return false;
    tiles_.push_back(place);
    return true;
  }

 private:
  bool addFiner(const TilePlace& place) {
    const PyramidLevel &own = levelOf(levels_, place),
                       &next = levels_[static_cast<std::size_t>(place.level - 1)];
    const Range columns = finer(place.column, own.columns, next.columns);
    const Range rows = finer(place.row, own.rows, next.rows);
    for (std::int32_t row = rows.first; row < rows.end; ++row) {
      for (std::int32_t column = columns.first; column < columns.end; ++column) {
        if (!add({place.level - 1, column, row})) return false;
      }
    }
    return true;
  }

  Levels levels_;
  const Surface& surface_;
  const PictureView& view_;
  double pixel_px_;
  std::size_t most_;
  std::vector<TilePlace>& tiles_;
};

}  // namespace

PixelRect rectOf(Levels levels, const TilePlace& place) {
  const PyramidLevel& level = levelOf(levels, place);
  const double size = std::ldexp(double{image::kTileSide}, place.level);
  const auto end = [&](std::int32_t tile, std::int64_t tiles, std::int64_t whole) {
    return tile + 1 == tiles ? static_cast<double>(whole) : (tile + 1) * size;
  };
  return {place.column * size, place.row * size, end(place.column, level.columns, levels[0].width),
          end(place.row, level.rows, levels[0].height)};
}

TilePlace parentOf(Levels levels, const TilePlace& place) {
  const PyramidLevel& coarser = levels[static_cast<std::size_t>(place.level + 1)];
  const auto half = [](std::int32_t tile, std::int64_t tiles) {
    return static_cast<std::int32_t>(std::min<std::int64_t>(tile / 2, tiles - 1));
  };
  return {place.level + 1, half(place.column, coarser.columns), half(place.row, coarser.rows)};
}

bool chooseTiles(Levels levels, const Surface& surface, const PictureView& view, double pixel_px,
                 std::size_t most, std::vector<TilePlace>& tiles) {
  Chooser chooser(levels, surface, view, pixel_px, most, tiles);
  const PyramidLevel& coarsest = levels.back();
  const int level = static_cast<int>(levels.size()) - 1;
  for (std::int32_t row = 0; row < coarsest.rows; ++row) {
    for (std::int32_t column = 0; column < coarsest.columns; ++column) {
      if (!chooser.add({level, column, row})) return false;
    }
  }
  return true;
}

}  // namespace merlin::render::content
