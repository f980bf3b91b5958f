#include "render/fuse/tetrahedra.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::render::fuse {
namespace {

// Six tetrahedra of a cell. The bits of a corner's number are its coordinates: 1 is x, 2 is y, 4 is
// z. A tetrahedron goes from corner 0 to 7 along one axis after another; the last two corners of
// the odd orders are swapped, so that all six have the same orientation: the determinant of the
// edges from the first corner is positive.
constexpr unsigned kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                        {0, 1, 7, 5}, {0, 2, 7, 3}, {0, 4, 7, 6}};

// A vertex is at least this share of its edge away from both ends, so that no triangle has two
// equal corners.
constexpr float kMargin = 0.02F;

constexpr std::size_t indexOf(std::size_t x, std::size_t y, std::size_t z) {
  return (z * kCorners + y) * kCorners + x;
}

struct Vertex {
  std::uint64_t key;
  float place;
};

class Marching {
 public:
  Marching(const Values& values, const Lattice& block) : values_(values), block_(block) {}

  Piece run() {
    for (std::size_t z = 0; z < kCells; ++z)
      for (std::size_t y = 0; y < kCells; ++y)
        for (std::size_t x = 0; x < kCells; ++x) addCell(x, y, z);
    return numbered();
  }

 private:
  void addCell(std::size_t x, std::size_t y, std::size_t z) {
    unsigned inside = 0, outside = 0;
    for (unsigned c = 0; c < 8; ++c) {
      const float v = values_[indexOf(x + (c & 1U), y + (c >> 1U & 1U), z + (c >> 2U))];
      cell_[c] = v;
      inside |= (v < 0 ? 1U : 0U) << c;
      outside |= (v >= 0 ? 1U : 0U) << c;
    }
    if (inside == 0 || outside == 0) return;
    const std::array<std::size_t, 3> at = {x, y, z};
    for (std::size_t k = 0; k < 3; ++k)
      corner_[k] = block_[k] * std::uint32_t{kCells} + static_cast<std::uint32_t>(at[k]);
    for (const auto& tetrahedron : kTetrahedra) addTetrahedron(tetrahedron, inside, outside);
  }

  // Adds the triangles of one tetrahedron. Orders its corners, inside first, and tracks whether the
  // permutation is even, so that the triangles face outwards.
  void addTetrahedron(const unsigned (&t)[4], unsigned inside, unsigned outside) {
    std::array<unsigned, 4> in{}, out{};
    std::size_t ins = 0, outs = 0;
    unsigned swaps = 0;
    for (const unsigned c : t) {
      if (!((inside | outside) >> c & 1U)) return;  // a corner is unknown
      if (inside >> c & 1U) {
        swaps += static_cast<unsigned>(outs);
        in[ins++] = c;
      } else {
        out[outs++] = c;
      }
    }
    if (ins == 0 || outs == 0) return;
    const bool odd = swaps & 1U;
    if (ins == 1) {
      addTriangle({in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]}, odd);
    } else if (ins == 3) {
      addTriangle({in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]}, odd);
    } else {
      addTriangle({in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]}, odd);
      addTriangle({in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]}, odd);
    }
  }

  using Ends = std::pair<unsigned, unsigned>;
  void addTriangle(const Ends& a, const Ends& b, const Ends& c, bool turned) {
    const std::array<Ends, 3> order =
        turned ? std::array<Ends, 3>{a, c, b} : std::array<Ends, 3>{a, b, c};
    for (const Ends& ends : order) vertices_.push_back(vertexOn(ends));
  }

  Vertex vertexOn(const Ends& ends) const {
    // Its bits are a subset of those of `high`.
    const unsigned low = std::min(ends.first, ends.second);
    const unsigned high = std::max(ends.first, ends.second);
    std::uint64_t key = 0;
    for (unsigned k = 3; k-- > 0;) key = key << 20U | (corner_[k] + (low >> k & 1U));
    const float a = cell_[low], b = cell_[high];
    return {key << 3U | (high ^ low), std::clamp(a / (a - b), kMargin, 1 - kMargin)};
  }

  Piece numbered() const {
    Piece piece;
    std::vector<Vertex> sorted = vertices_;
    const auto before = [](const Vertex& a, const Vertex& b) { return a.key < b.key; };
    std::sort(sorted.begin(), sorted.end(), before);
    for (const Vertex& v : sorted) {
      if (!piece.keys.empty() && piece.keys.back() == v.key) continue;
      piece.keys.push_back(v.key);
      piece.places.push_back(v.place);
    }
    piece.keys.shrink_to_fit();
    piece.places.shrink_to_fit();
    piece.triangles.reserve(vertices_.size());
    for (const Vertex& v : vertices_) {
      const auto at = std::lower_bound(piece.keys.begin(), piece.keys.end(), v.key);
      piece.triangles.push_back(static_cast<std::uint32_t>(at - piece.keys.begin()));
    }
    return piece;
  }

  const Values& values_;
  const Lattice& block_;
  std::array<float, 8> cell_{};
  Lattice corner_{};
  std::vector<Vertex> vertices_{};  // three per triangle
};

}  // namespace

Edge edgeOf(std::uint64_t key) noexcept {
  Edge edge;
  for (unsigned k = 0; k < 3; ++k) {
    edge.step[k] = static_cast<std::uint32_t>(key >> k & 1U);
    edge.corner[k] = static_cast<std::uint32_t>(key >> (3 + 20 * k)) & (kMostCorners - 1);
  }
  return edge;
}

Piece surfaceIn(const Values& values, const Lattice& block) {
  return Marching(values, block).run();
}

std::uint8_t crossedSides(const Values& values) noexcept {
  unsigned sides = 0;
  for (unsigned side = 0; side < 6; ++side) {
    const std::size_t fixed = side & 1U ? kCells : 0, axis = side / 2;
    bool inside = false, outside = false;
    for (std::size_t i = 0; i < kCorners * kCorners; ++i) {
      std::array<std::size_t, 3> at{};
      at[axis] = fixed;
      at[(axis + 1) % 3] = i / kCorners;
      at[(axis + 2) % 3] = i % kCorners;
      const float v = values[indexOf(at[0], at[1], at[2])];
      inside |= v < 0;
      outside |= v >= 0;
    }
    sides |= (inside && outside ? 1U : 0U) << side;
  }
  return static_cast<std::uint8_t>(sides);
}

}  // namespace merlin::render::fuse
