// Packs rectangles into one larger rectangle, without rotating them. Pure.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace merlin::render::mesh {

struct RectangleSize {
  int width = 0, height = 0;
};

struct Packing {
  RectangleSize size{};
  struct Place {
    int x = 0, y = 0;
  };
  std::vector<Place> places{};  // one per rectangle, in the given order
};

// Packs the rectangles without overlap into a rectangle whose width and height are at most `most`;
// returns nothing if they do not fit. Tries several widths and returns the result whose longer side
// is shortest. Rectangles of equal size are packed in the given order. O(n * most / smallest
// width). REQUIRES: every side is at least 1. Source: J. Jylänki, "A Thousand Ways to Pack the
// Bin", 2010, the bottom-left skyline.
std::optional<Packing> pack(std::span<const RectangleSize> sizes, int most);

}  // namespace merlin::render::mesh
