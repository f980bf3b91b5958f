#include "render/testcard/card_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "render/frame/tile_arrangement.h"
#include "render/tiles/plane_parts.h"

namespace merlin::render::testcard {
namespace {

// A tile in an output's picture: its place there and how it is turned.
struct Shown {
  std::size_t tile = 0;
  int x = 0, y = 0, width = 0, height = 0;  // on the output [px]
  frame::TileAxes axes;
};

std::vector<Shown> shownBy(const out::OutputSettings& output, const tiles::TilePlan& plan) {
  std::vector<Shown> all;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    const tiles::Tile& tile = plan.tiles[i];
    if (output.tiles.empty()) {
      all.push_back({i, tile.x, tile.y, tile.width, tile.height, {}});
      continue;
    }
    for (const out::PlacedTile& placed : output.tiles) {
      if (placed.tile != tile.name && placed.right_eye != tile.name) continue;
      const frame::TileAxes axes = frame::axesOf(placed);
      const bool on_side = axes.column.x == 0;
      all.push_back({i, placed.x, placed.y, on_side ? tile.height : tile.width,
                     on_side ? tile.width : tile.height, axes});
    }
  }
  return all;
}

// Returns which corner of the tile's place on the output (column, row; each 0 or 1) is this corner
// of the tile.
std::pair<int, int> cornerOnOutput(const frame::TileAxes& axes, int column, int row) {
  const auto along = [&](int by_column, int by_row) {
    const int step = by_column != 0 ? by_column : by_row;
    const int end = by_column != 0 ? column : row;
    return step > 0 ? end : 1 - end;
  };
  return {along(axes.column.x, axes.row.x), along(axes.column.y, axes.row.y)};
}

// Returns the side of an output (0 left, 1 right, 2 top, 3 bottom) to which a step leads.
std::size_t sideOf(const frame::TileAxes::Step& step) {
  if (step.x != 0) return step.x > 0 ? 1 : 0;
  return step.y > 0 ? 3 : 2;
}

// Adds the strips of the output's picture to the tile, as far as they reach into it.
void addStrips(CardTile& tile, const Shown& shown, const out::PictureSize& size,
               const correct::BlendSettings& blend) {
  const std::array<double, 4> strips = {
      blend.left - shown.x, blend.right - (size.width - shown.x - shown.width), blend.top - shown.y,
      blend.bottom - (size.height - shown.y - shown.height)};
  const auto widen = [&](int& strip, std::size_t side, int most) {
    strip = std::max(strip, std::min(most, static_cast<int>(std::lround(strips[side]))));
  };
  const frame::TileAxes::Step column = shown.axes.column, row = shown.axes.row;
  widen(tile.left, sideOf({-column.x, -column.y}), tile.width);
  widen(tile.right, sideOf(column), tile.width);
  widen(tile.top, sideOf({-row.x, -row.y}), tile.height);
  widen(tile.bottom, sideOf(row), tile.height);
}

out::PictureSize sizeOf(const out::OutputSettings& output, const tiles::TilePlan& plan) {
  if (output.tiles.empty()) return {plan.frame_width, plan.frame_height};
  out::PictureSize size;
  for (const Shown& s : shownBy(output, plan)) {
    size.width = std::max(size.width, s.x + s.width);
    size.height = std::max(size.height, s.y + s.height);
  }
  return size;
}

// Returns the name of the tile that was made into one for each eye: "left" for "left.L".
std::string nameForBothEyes(const tiles::Tile& tile) {
  return tile.eye == tiles::Eye::kMiddle ? tile.name : tile.name.substr(0, tile.name.rfind('.'));
}

// Returns whether the tile is in an anaglyph, where both eyes' tiles are shown at the same place
// and so must show the same text.
bool isInAnaglyph(const tiles::Tile& tile, const std::vector<out::OutputSettings>& outputs) {
  return std::ranges::any_of(outputs, [&](const out::OutputSettings& output) {
    return std::ranges::any_of(output.tiles, [&](const out::PlacedTile& placed) {
      return !placed.right_eye.empty() &&
             (placed.tile == tile.name || placed.right_eye == tile.name);
    });
  });
}

// Returns the tiles with their parts of their planes, and with the strips that neighbours on the
// plane show as well.
std::vector<CardTile> placedTiles(const tiles::TilePlan& plan) {
  const auto parts = tiles::planeParts(plan);
  const auto strips = tiles::sharedStrips(plan, parts);
  std::vector<CardTile> all;
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
    const tiles::Tile& t = plan.tiles[i];
    all.push_back({t.name, t.x, t.y, t.width, t.height});
    if (!parts[i]) continue;
    const tiles::PlanePart& p = *parts[i];
    const auto pixels = [](double metres, int size, double length) {
      return static_cast<int>(std::lround(metres / length * size));
    };
    CardTile& tile = all.back();
    tile.part = {p.left, p.top, p.width, p.height, p.plane_width, p.plane_height};
    tile.left = pixels(strips[i].left, t.width, p.width);
    tile.right = pixels(strips[i].right, t.width, p.width);
    tile.top = pixels(strips[i].top, t.height, p.height);
    tile.bottom = pixels(strips[i].bottom, t.height, p.height);
  }
  return all;
}

}  // namespace

std::vector<CardTile> cardTiles(const tiles::TilePlan& plan,
                                const std::vector<out::OutputSettings>& outputs,
                                const std::map<std::string, std::string>& panels) {
  std::vector<CardTile> tiles = placedTiles(plan);
  for (const out::OutputSettings& output : outputs) {
    if (output.kind == out::OutputKind::kSharedMemory) continue;
    const out::PictureSize size = sizeOf(output, plan);
    for (const Shown& shown : shownBy(output, plan)) {
      CardTile& tile = tiles[shown.tile];
      tile.lines.push_back(fmt::format("output {}", output.shownName()));
      addStrips(tile, shown, size, output.correction.blend);
    }
  }
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    CardTile& tile = tiles[i];
    const std::string name = nameForBothEyes(plan.tiles[i]);
    tile.lines.push_back(fmt::format("{} x {}", tile.width, tile.height));
    if (isInAnaglyph(plan.tiles[i], outputs)) tile.name = name;
    const auto panel = panels.find(name);
    if (panel != panels.end()) tile.lines.push_back(fmt::format("panel {}", panel->second));
  }
  return tiles;
}

std::optional<MarkedCorner> cornerOf(const tiles::TilePlan& plan, const out::OutputSettings& output,
                                     std::size_t corner) {
  const out::PictureSize size = sizeOf(output, plan);
  const int column = static_cast<int>(corner % 2), row = static_cast<int>(corner / 2);
  for (const Shown& s : shownBy(output, plan)) {
    const bool there = (column == 0 ? s.x == 0 : s.x + s.width == size.width) &&
                       (row == 0 ? s.y == 0 : s.y + s.height == size.height);
    for (std::size_t i = 0; there && i < 4; ++i) {
      if (cornerOnOutput(s.axes, static_cast<int>(i % 2), static_cast<int>(i / 2)) ==
          std::pair(column, row))
        return MarkedCorner{s.tile, i};
    }
  }
  return std::nullopt;
}

}  // namespace merlin::render::testcard
