// Determines the part of a frame that a VNC client sees, and which areas of it have changed. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/out/shared_frame.h"

namespace merlin::rfb {

struct View {
  enum class Kind { kWall, kOperator, kTile };
  Kind kind = Kind::kWall;
  std::string tile;  // for kTile: its name
};
std::string viewName(const View& view);  // "the wall", "tile left"

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;  // [px], from the upper left corner
  bool operator==(const Rectangle&) const = default;
};

// How a view is put together from rectangles of the frame.
struct Layout {
  struct Piece {
    Rectangle from;          // in the frame
    int to_x = 0, to_y = 0;  // its upper left corner in the view
  };
  int width = 0, height = 0;  // of the view [px]
  std::vector<Piece> pieces;
};

// Returns the layout of a view: the wall's tiles in rows and columns, the operator's view, or one
// tile. Errors: kNotFound (the wall has no such tile; the text lists those that it has),
// kUnsupported (a wall too large to be shown).
Result<Layout> layoutOf(const render::out::CapturedFrame& frame, const View& view);

// Copies the view into `canvas` (RGBA, rows from top to bottom), and returns the blocks, of 64 x 64
// pixels at most, that differ from what was there. REQUIRES: `canvas` has the layout's size. Costs
// a comparison of all pixels and a copy of those that changed.
std::vector<Rectangle> copyChanged(const render::out::CapturedFrame& frame, const Layout& layout,
                                   std::span<std::uint8_t> canvas);

}  // namespace merlin::rfb
