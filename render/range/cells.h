// Describes the cells of a range image: the triangles of each cell, and how they meet at a pixel.
// Private to render/range.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace merlin::render::range {

// The corners of a cell: a at the top left, b at the top right, c at the bottom right, d at the
// bottom left. A cell has up to two triangles, counter-clockwise as the scanner sees them. If its
// diagonal is ac, they are a d c and a c b; if it is bd, they are a d b and b d c.
enum Corner : std::uint8_t { kA, kB, kC, kD };

// The triangles of a cell as bits: kAcrossBd (the diagonal is bd), kFirst and kSecond (which
// triangles exist).
using Cell = std::uint8_t;
inline constexpr Cell kAcrossBd = 1, kFirst = 2, kSecond = 4;

inline constexpr Corner kTriangles[2][2][3] = {{{kA, kD, kC}, {kA, kC, kB}},
                                               {{kA, kD, kB}, {kB, kD, kC}}};

// Describes how the triangles of the four cells around a pixel are connected at the pixel. The
// cells are numbered clockwise from the top right: the pixel is corner d of cell 0, a of cell 1, b
// of cell 2 and c of cell 3. Two successive cells share an edge of the grid. `sides` has two bits
// per cell: 1 if a triangle of the cell at the pixel uses the edge before the cell, 2 if it uses
// the edge after the cell. The triangles of one cell at one pixel are always connected.
struct Fans {
  std::uint8_t count = 0;    // number of fans of triangles at the pixel, 0 to 4
  std::uint8_t of_cell = 0;  // two bits per cell: the index of its fan
};
inline constexpr std::uint8_t kClosed = 0xFF;  // `sides` of a pixel inside the surface
inline constexpr Corner kRing[4] = {kD, kA, kB, kC};

constexpr std::uint8_t sidesAt(Corner corner, Cell cell) {
  // [corner][diagonal][triangle]: bits of the edges that the triangle uses.
  constexpr std::uint8_t kSides[4][2][2] = {{{2, 1}, {3, 0}},   // a: b before, d after
                                            {{0, 3}, {2, 1}},   // b: c before, a after
                                            {{1, 2}, {0, 3}},   // c: d before, b after
                                            {{3, 0}, {1, 2}}};  // d: a before, c after
  const auto& of = kSides[corner][cell & kAcrossBd];
  return static_cast<std::uint8_t>((cell & kFirst ? of[0] : 0) | (cell & kSecond ? of[1] : 0));
}

constexpr Fans fansOf(std::uint8_t sides) {
  Fans fans;
  if (sides == kClosed) return {1, 0};
  const auto of = [&](unsigned cell) { return unsigned{sides} >> 2 * (cell & 3U) & 3U; };
  const auto joins = [&](unsigned cell) { return (of(cell) & 2U) && (of(cell + 1) & 1U); };
  unsigned start = 0;  // first cell that is not joined to the cell before it
  while (joins(start + 3)) ++start;
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned cell = (start + i) & 3U;
    if (of(cell) == 0) continue;
    if (i == 0 || !joins(cell + 3)) ++fans.count;
    fans.of_cell =
        static_cast<std::uint8_t>(unsigned{fans.of_cell} | (fans.count - 1U) << 2 * cell);
  }
  return fans;
}

constexpr std::array<Fans, 256> makeFanTable() {
  std::array<Fans, 256> table{};
  for (unsigned sides = 0; sides < 256; ++sides)
    table[sides] = fansOf(static_cast<std::uint8_t>(sides));
  return table;
}
inline constexpr std::array<Fans, 256> kFans = makeFanTable();

}  // namespace merlin::render::range
