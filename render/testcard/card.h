// Test cards: patterns that a wall shows while somebody sets up its projectors and displays. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::render::testcard {

// In the order of kCardNames.
enum class Card { kGrid, kEdges, kRamps, kNames, kFocus, kAllBlack, kAllGrey, kAllWhite };
inline constexpr const char* kCardNames[] = {"grid",  "edges", "ramps", "names",
                                             "focus", "black", "grey",  "white"};
inline constexpr std::size_t kCards = 8;
std::optional<Card> cardNamed(std::string_view name);

// The part of a plane that a tile shows, from the plane's upper left corner. The plane is what the
// tiles on one flat screen show together, so that a card's lines meet from one to the next, also
// where they overlap. Lengths are in metres; for a tile without a screen, in its pixels.
struct CardPart {
  double left = 0, top = 0, width = 0, height = 0;
  double plane_width = 0, plane_height = 0;
};

// A tile, with what a card shows of it.
struct CardTile {
  std::string name;
  int x = 0, y = 0, width = 0, height = 0;  // in the canvas [px]
  std::vector<std::string> lines{};  // lines that the card "names" shows below the tile's name
  // Strips at its borders that a neighbour shows as well [px].
  int left = 0, right = 0, top = 0, bottom = 0;
  CardPart part{};  // if its width is 0: the tile is a plane of its own
};

// A corner of a tile that is marked. `tile`: index; `corner`: 2 * row + column.
struct MarkedCorner {
  std::size_t tile = 0, corner = 0;
};

// Draws a card into each tile of a canvas (RGBA, `canvas_width` pixels a row), which contains the
// tiles.
//   grid   lines at equal distances on the plane, the border, diagonals, circles: for geometry
//   edges  the tile's outermost pixels, its corners (red, green, blue, yellow: upper left, upper
//          right, lower left, lower right), strips of overlap with their inner edges
//   ramps  grey, red, green, blue, from 0 to 255 along the plane; 17 steps of grey; steps near
//          black and white
//   names  tile, output, size, panel
//   focus  checkers and lines of single pixels, Siemens stars, small text
//   black, grey, white  one colour: for overlaps, which are to be as bright as the rest
// `mark`: a corner that is being moved, on the cards grid and edges. Costs some milliseconds per
// million pixels.
void drawCard(Card card, std::span<const CardTile> tiles, std::optional<MarkedCorner> mark,
              std::span<std::uint8_t> canvas, int canvas_width);

}  // namespace merlin::render::testcard
