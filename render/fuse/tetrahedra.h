// Computes the iso-surface of a block of values by marching tetrahedra. Private to render/fuse.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace merlin::render::fuse {

inline constexpr std::size_t kCells = 8;  // number of cells of a block along an axis
// Corners along an axis; those at the sides are shared.
inline constexpr std::size_t kCorners = kCells + 1;
inline constexpr std::size_t kValues = kCorners * kCorners * kCorners;
using Lattice = std::array<std::uint32_t, 3>;            // indices of a corner or of a block
inline constexpr std::uint32_t kMostCorners = 1U << 20;  // limit of corners along an axis

// Values at the corners of a block, with x varying fastest: positive means outside, negative
// inside, NaN unknown.
using Values = std::array<float, kValues>;

// The part of the surface in one block.
struct Piece {
  std::vector<std::uint64_t> keys{};       // by vertex: key of its lattice edge, ascending
  std::vector<float> places{};             // by vertex: position along that edge, 0..1
  std::vector<std::uint32_t> triangles{};  // triangles x 3: indices of vertices of the piece
};

// An edge of the lattice, on which a vertex lies: from `corner` to corner + step. Each component of
// `step` is 0 or 1, and not all are 0.
struct Edge {
  Lattice corner{}, step{};
};
Edge edgeOf(std::uint64_t key) noexcept;

// Returns the surface where the values change sign, in those tetrahedra whose corners are all
// known. Each cell is divided into six tetrahedra along its main diagonal ([KUHN60]), so that
// neighbouring cells agree on their common face: the surface has no edge with three triangles, and
// is closed where nothing is unknown. Triangles are counter-clockwise from outside. `block`:
// position of the block, in units of blocks. O(kValues).
Piece surfaceIn(const Values& values, const Lattice& block);

// Returns the sides of the block that the surface crosses, as bits 2 axis + (0: low, 1: high side).
std::uint8_t crossedSides(const Values& values) noexcept;

}  // namespace merlin::render::fuse
