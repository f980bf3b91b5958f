// Packs rectangles into one, without turning them. Pure.
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
  std::vector<Place> places{};  // of each rectangle, in the given order
};

// Places the rectangles beside each other in one whose sides are at most `most`; nothing if that
// does not succeed. Several widths are tried, and the result with the shortest longer side is
// taken. Ties are broken by the order of the rectangles. O(n * most / smallest width). REQUIRES:
// every side is at least 1.
// Source: J. Jylänki, "A Thousand Ways to Pack the Bin", 2010, the bottom-left skyline.
std::optional<Packing> pack(std::span<const RectangleSize> sizes, int most);

}  // namespace merlin::render::mesh
