#include "daemon/rfb/view.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::rfb {
namespace {

using render::out::CapturedFrame;
using render::out::framebuffer::TileRectangle;

constexpr int kMostSide = 65535;  // the protocol's limit [px]
constexpr int kBlock = 64;        // [px]: small enough that a moving pointer sends little

// Returns the tile's name. It may lack its NUL, because another program has written the header.
std::string nameOf(const TileRectangle& tile) {
  const char* const end = std::find(std::begin(tile.name), std::end(tile.name), '\0');
  return {std::begin(tile.name), end};
}

bool shows(const TileRectangle& tile, const View& view) {
  switch (view.kind) {
    case View::Kind::kWall: return tile.wall_x >= 0;
    case View::Kind::kOperator: return tile.kind == 1;
    case View::Kind::kTile: break;
  }
  return nameOf(tile) == view.tile;
}

Error lacks(const CapturedFrame& frame, const View& view) {
  std::vector<std::string> names;
  for (const TileRectangle& tile : frame.tiles) names.push_back(nameOf(tile));
  const std::string tiles = fmt::format("its tiles are {}", fmt::join(names, ", "));
  switch (view.kind) {
    case View::Kind::kWall:
      return {Errc::kNotFound, fmt::format("this wall has no tile of kind wall; {}", tiles)};
    case View::Kind::kOperator:
      return {Errc::kNotFound, fmt::format("this wall has no operator's view; {}", tiles)};
    case View::Kind::kTile: break;
  }
  return {Errc::kNotFound, fmt::format("this wall has no tile {}; {}", view.tile, tiles)};
}

std::size_t offset(int x, int y, int width) {
  return std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x));
}

}  // namespace

std::string viewName(const View& view) {
  switch (view.kind) {
    case View::Kind::kWall: return "the wall";
    case View::Kind::kOperator: return "the operator's view";
    case View::Kind::kTile: break;
  }
  return fmt::format("tile {}", view.tile);
}

Result<Layout> layoutOf(const CapturedFrame& frame, const View& view) {
  Layout layout;
  const bool wall = view.kind == View::Kind::kWall;
  if (wall) {
    layout.width = frame.wall_width;
    layout.height = frame.wall_height;
  }
  for (const TileRectangle& tile : frame.tiles) {
    if (!shows(tile, view) || tile.width <= 0 || tile.height <= 0) continue;
    Rectangle from{tile.x, tile.y, tile.width, tile.height};
    if (!wall) return Layout{tile.width, tile.height, {{from, 0, 0}}};
    layout.pieces.push_back({from, tile.wall_x, tile.wall_y});
  }
  if (layout.pieces.empty() || layout.height <= 0) return lacks(frame, view);
  if (layout.width > kMostSide || layout.height > kMostSide ||
      offset(0, layout.height, layout.width) > 4 * render::out::kMostWallPixels) {
    return Error{
        Errc::kUnsupported,
        fmt::format("the wall's tiles in rows and columns are {} x {} pixels, too many for "
                    "VNC; choose one tile, or the operator's view",
                    layout.width, layout.height)};
  }
  return layout;
}

std::vector<Rectangle> copyChanged(const CapturedFrame& frame, const Layout& layout,
                                   std::span<std::uint8_t> canvas) {
  assert(canvas.size() == offset(0, layout.height, layout.width));
  std::vector<Rectangle> changed;
  const auto copyBlock = [&](int from_x, int from_y, const Rectangle& to) {
    const std::size_t bytes = std::size_t{4} * static_cast<std::size_t>(to.width);
    bool differs = false;
    for (int row = 0; row < to.height; ++row) {
      const auto* const from = frame.pixels.data() + offset(from_x, from_y + row, frame.width);
      auto* const at = canvas.data() + offset(to.x, to.y + row, layout.width);
      if (std::memcmp(at, from, bytes) == 0) continue;
      std::memcpy(at, from, bytes);
      differs = true;
    }
    if (differs) changed.push_back(to);
  };
  for (const auto& [from, to_x, to_y] : layout.pieces) {
    for (int y = 0; y < from.height; y += kBlock) {
      for (int x = 0; x < from.width; x += kBlock) {
        copyBlock(from.x + x, from.y + y,
                  {to_x + x, to_y + y, std::min(kBlock, from.width - x),
                   std::min(kBlock, from.height - y)});
      }
    }
  }
  return changed;
}

}  // namespace merlin::rfb
