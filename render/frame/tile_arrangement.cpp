#include "render/frame/tile_arrangement.h"

#include <algorithm>
#include <cstring>

namespace merlin::render {
namespace {

const Tile& tileOf(const TilePlan& plan, const PlacedTile& placed) {
  return *std::ranges::find(plan.tiles, placed.tile, &Tile::name);
}

bool liesOnItsSide(const PlacedTile& placed) {
  return placed.turn == Turn::k90 || placed.turn == Turn::k270;
}

}  // namespace

TileArrangement::TileArrangement(const TilePlan& plan, const std::vector<PlacedTile>& tiles) {
  for (const PlacedTile& p : tiles) {
    const Tile& t = tileOf(plan, p);
    width_ = std::max(width_, p.x + (liesOnItsSide(p) ? t.height : t.width));
    height_ = std::max(height_, p.y + (liesOnItsSide(p) ? t.width : t.height));
  }
  pixels_.assign(
      std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (std::size_t i = 3; i < pixels_.size(); i += 4) pixels_[i] = 255;
  for (const PlacedTile& p : tiles) {
    const Tile& t = tileOf(plan, p);
    // Steps to the next column and row of the tile on the output, and the tile's corner there.
    struct Step {
      int x, y;
    };
    constexpr Step kColumns[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    constexpr Step kRows[] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    Step column = kColumns[static_cast<int>(p.turn)], row = kRows[static_cast<int>(p.turn)];
    int x = p.x, y = p.y;
    if (p.mirror == Mirror::kHorizontal) column = {-column.x, -column.y};
    if (p.mirror == Mirror::kVertical) row = {-row.x, -row.y};
    for (const auto& [step, count] : {std::pair{column, t.width}, std::pair{row, t.height}}) {
      x += step.x < 0 ? count - 1 : 0;
      y += step.y < 0 ? count - 1 : 0;
    }
    const auto at = [&](int dx, int dy) { return static_cast<std::ptrdiff_t>(dy) * width_ + dx; };
    placed_.push_back(
        {t.x, t.y, t.width, t.height, at(x, y), at(column.x, column.y), at(row.x, row.y)});
  }
}

Signal TileArrangement::apply(const Signal& canvas) {
  for (const Placed& p : placed_) {
    for (int y = 0; y < p.height; ++y) {
      const std::uint8_t* from =
          canvas.pixels.data() + 4 * (static_cast<std::ptrdiff_t>(p.y + y) * canvas.width + p.x);
      std::uint8_t* to = pixels_.data() + 4 * (p.first + y * p.row);
      if (p.column == 1) {
        std::memcpy(to, from, static_cast<std::size_t>(4) * static_cast<std::size_t>(p.width));
        continue;
      }
      for (int x = 0; x < p.width; ++x, from += 4, to += 4 * p.column) std::memcpy(to, from, 4);
    }
  }
  return {width_, height_, pixels_};
}

}  // namespace merlin::render
