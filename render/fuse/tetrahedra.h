// Tetrahedra: the iso-surface of a block of values by marching tetrahedra. Private to render/fuse.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace merlin::render::fuse {

inline constexpr std::size_t kCells = 8;             // of a block, along an axis
inline constexpr std::size_t kCorners = kCells + 1;  // shared with the neighbours
inline constexpr std::size_t kValues = kCorners * kCorners * kCorners;
using Lattice = std::array<std::uint32_t, 3>;            // coordinates of a corner, or of a block
inline constexpr std::uint32_t kMostCorners = 1U << 20;  // along an axis of the lattice

// Values at the corners of a block, x fastest: positive outside, negative inside, NaN unknown.
using Values = std::array<float, kValues>;

// The surface in one block.
struct Piece {
  std::vector<std::uint64_t> keys{};       // of its vertices, increasing: one key per lattice edge
  std::vector<float> places{};             // of its vertices: share of the way along that edge
  std::vector<std::uint32_t> triangles{};  // x 3: index of a vertex of the piece
};

// A vertex lies on an edge of the lattice from `corner` to the corner that `step` leads to (each
// 0 or 1, not all 0).
struct Edge {
  Lattice corner{}, step{};
};
Edge edgeOf(std::uint64_t key) noexcept;

// The surface where the values change sign, in the tetrahedra of which no corner is unknown. Each
// cell is divided into six tetrahedra along its main diagonal ([KUHN60]), so neighbours agree on
// each face: the surface has no edge with three triangles, and is closed where nothing is unknown.
// Triangles are counter-clockwise from outside. `block`: in units of blocks. O(kValues).
Piece surfaceIn(const Values& values, const Lattice& block);

// Sides of the block that the surface crosses; bits 2 axis + (0 low, 1 high).
std::uint8_t crossedSides(const Values& values) noexcept;

}  // namespace merlin::render::fuse
