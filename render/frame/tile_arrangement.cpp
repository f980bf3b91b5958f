#include "render/frame/tile_arrangement.h"

#include <algorithm>
#include <cstring>

#include "render/stereo/anaglyph.h"

namespace merlin::render::frame {
namespace {

const tiles::Tile& tileOf(const tiles::TilePlan& plan, const std::string& name) {
  return *std::ranges::find(plan.tiles, name, &tiles::Tile::name);
}

bool liesOnItsSide(const out::PlacedTile& placed) {
  return placed.turn == out::Turn::k90 || placed.turn == out::Turn::k270;
}

}  // namespace

TileAxes axesOf(const out::PlacedTile& placed) {
  using Step = TileAxes::Step;
  constexpr Step kColumns[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  constexpr Step kRows[] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
  const auto turn = static_cast<std::size_t>(placed.turn);
  TileAxes axes{kColumns[turn], kRows[turn]};
  if (placed.mirror == out::Mirror::kHorizontal) axes.column = {-axes.column.x, -axes.column.y};
  if (placed.mirror == out::Mirror::kVertical) axes.row = {-axes.row.x, -axes.row.y};
  return axes;
}

TileArrangement::TileArrangement(const tiles::TilePlan& plan,
                                 const std::vector<out::PlacedTile>& tiles) {
  for (const out::PlacedTile& p : tiles) {
    const tiles::Tile& t = tileOf(plan, p.tile);
    width_ = std::max(width_, p.x + (liesOnItsSide(p) ? t.height : t.width));
    height_ = std::max(height_, p.y + (liesOnItsSide(p) ? t.width : t.height));
  }
  pixels_.assign(
      std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (std::size_t i = 3; i < pixels_.size(); i += 4) pixels_[i] = 255;
  for (const out::PlacedTile& p : tiles) {
    const tiles::Tile& t = tileOf(plan, p.tile);
    const auto [column, row] = axesOf(p);
    int x = p.x, y = p.y;  // position of the tile's upper left pixel on the output
    for (const auto& [step, count] : {std::pair{column, t.width}, std::pair{row, t.height}}) {
      x += step.x < 0 ? count - 1 : 0;
      y += step.y < 0 ? count - 1 : 0;
    }
    const auto at = [&](int dx, int dy) { return static_cast<std::ptrdiff_t>(dy) * width_ + dx; };
    placed_.push_back(
        {t.x, t.y, t.width, t.height, at(x, y), at(column.x, column.y), at(row.x, row.y)});
    if (p.right_eye.empty()) continue;
    const tiles::Tile& right = tileOf(plan, p.right_eye);
    placed_.back().right_x = right.x - t.x;
    placed_.back().right_y = right.y - t.y;
  }
}

const std::uint8_t* TileArrangement::rowOf(const Placed& p, int y, const out::Signal& canvas) {
  const auto row = [&](int dx, int dy) {
    const std::ptrdiff_t first =
        static_cast<std::ptrdiff_t>(p.y + dy + y) * canvas.width + p.x + dx;
    return canvas.pixels.subspan(static_cast<std::size_t>(4 * first),
                                 static_cast<std::size_t>(4) * static_cast<std::size_t>(p.width));
  };
  if (p.right_x == 0 && p.right_y == 0) return row(0, 0).data();
  line_.resize(static_cast<std::size_t>(4) * static_cast<std::size_t>(p.width));
  stereo::composeAnaglyph(row(0, 0), row(p.right_x, p.right_y), line_);
  return line_.data();
}

out::Signal TileArrangement::apply(const out::Signal& canvas) {
  for (const Placed& p : placed_) {
    for (int y = 0; y < p.height; ++y) {
      const std::uint8_t* from = rowOf(p, y, canvas);
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

}  // namespace merlin::render::frame
