#include "render/room/canvas.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <tuple>

namespace merlin::render::room {
namespace {

using InOrder = std::vector<tiles::TileSettings*>;

// Fills row after row, each up to `longest` pixels long; a row is as high as its first, tallest
// tile.
CanvasSize placeInRows(const InOrder& tiles, std::int64_t longest) {
  CanvasSize size;
  int x = 0, y = 0, row_height = 0;
  for (tiles::TileSettings* const t : tiles) {
    if (x > 0 && std::int64_t{x} + t->width > longest) {
      y += row_height;
      x = row_height = 0;
    }
    t->x = x;
    t->y = y;
    x += t->width;
    row_height = std::max(row_height, t->height);
    size.width = std::max(size.width, x);
    size.height = y + row_height;
  }
  return size;
}

std::int64_t areaOf(const CanvasSize& size) { return std::int64_t{size.width} * size.height; }

struct Rows {
  std::int64_t longest;
  CanvasSize size;
};

// Tries all useful row lengths and returns the one that gives the best frame; see placeOnCanvas().
Rows bestRows(const InOrder& tiles) {
  std::vector<Rows> all;
  std::int64_t longest = 0, least = std::numeric_limits<std::int64_t>::max();
  for (const tiles::TileSettings* const t : tiles) {
    longest += t->width;
    all.push_back({longest, placeInRows(tiles, longest)});
    least = std::min(least, areaOf(all.back().size));
  }
  const auto cost = [&](const Rows& rows) {
    return std::tuple(rows.size.isTooLarge(), 4 * areaOf(rows.size) > 5 * least,
                      std::max(rows.size.width, rows.size.height), areaOf(rows.size));
  };
  return *std::ranges::min_element(all, {}, cost);
}

}  // namespace

CanvasSize placeOnCanvas(std::vector<tiles::TileSettings>& tiles) {
  if (tiles.empty()) return {};
  InOrder sorted;
  for (tiles::TileSettings& t : tiles) sorted.push_back(&t);
  std::ranges::stable_sort(sorted, std::ranges::greater{}, &tiles::TileSettings::height);
  return placeInRows(sorted, bestRows(sorted).longest);
}

}  // namespace merlin::render::room
