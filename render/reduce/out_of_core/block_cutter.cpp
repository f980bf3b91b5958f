#include "render/reduce/out_of_core/block_cutter.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "render/reduce/quadric/quadric_mesh.h"

namespace merlin::render::reduce {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

// A piece under construction.
class BlockCutter::Piece {
 public:
  Piece(std::size_t begin, std::size_t size)
      : begin_(begin), numbers_(size, kNone), border_(size) {}

  bool has(std::uint32_t place) const { return place - begin_ < numbers_.size(); }

  void add(const std::uint32_t* triangle, const std::uint32_t* places) {
    for (int k = 0; k < 3; ++k) block.mesh.triangles.push_back(numberOf(triangle[k], places[k]));
  }

  // Marks the vertex at `place` as one with a neighbour outside the piece.
  void touch(std::uint32_t place) {
    if (has(place)) border_[place - begin_] = true;
  }

  Block finish(const mesh::Mesh& mesh, const std::vector<bool>& locked,
               const std::vector<std::uint32_t>& place) {
    numbers_ = {};
    guests_ = {};
    for (const std::uint32_t v : block.vertices) {
      const std::size_t at = place[v] - begin_;
      block.locked.push_back(at >= border_.size() || border_[at] || (!locked.empty() && locked[v]));
    }
    block.mesh.positions = rowsOf(mesh.positions, 3);
    for (const mesh::Feature& f : mesh.features)
      block.mesh.features.push_back({f.name, f.dimension, rowsOf(f.values, f.dimension)});
    return std::move(block);
  }

 private:
  std::uint32_t numberOf(std::uint32_t v, std::uint32_t place) {
    const auto next = static_cast<std::uint32_t>(block.vertices.size());
    std::uint32_t& number =
        has(place) ? numbers_[place - begin_] : guests_.try_emplace(v, kNone).first->second;
    if (number == kNone) {
      number = next;
      block.vertices.push_back(v);
    }
    return number;
  }

  std::vector<float> rowsOf(const std::vector<float>& values, std::size_t dimension) const {
    std::vector<float> rows(block.vertices.size() * dimension);
    for (std::size_t i = 0; i < block.vertices.size(); ++i)
      std::copy_n(&values[block.vertices[i] * dimension], dimension, &rows[i * dimension]);
    return rows;
  }

  Block block;
  std::size_t begin_;
  // By place along the curve: index of the vertex in the block.
  std::vector<std::uint32_t> numbers_;
  std::vector<bool> border_;
  // Indices in the block of the few vertices that lie outside the piece.
  std::unordered_map<std::uint32_t, std::uint32_t> guests_;
};

BlockCutter::BlockCutter(const mesh::Mesh& mesh, const std::vector<bool>& locked, Threads threads)
    : mesh_(mesh), locked_(locked), place_(mesh.vertexCount()) {
  const std::vector<std::uint32_t> curve = alongCurve(mesh, threads);
  for (std::uint32_t i = 0; i < curve.size(); ++i) place_[curve[i]] = i;
}

std::vector<Block> BlockCutter::cut(const Pieces& p) const {
  std::vector<Piece> pieces;
  for (std::size_t k = p.first; k <= p.last; ++k) {
    const std::size_t begin = std::min(k * p.stride, place_.size());
    pieces.emplace_back(begin, std::min(p.size, place_.size() - begin));
  }
  const auto pieceAt = [&](std::uint32_t place) -> Piece* {
    const std::size_t k = place / p.stride;
    if (k < p.first || k > p.last || !pieces[k - p.first].has(place)) return nullptr;
    return &pieces[k - p.first];
  };
  for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3) {
    const std::uint32_t* t = &mesh_.triangles[i];
    const std::uint32_t places[] = {place_[t[0]], place_[t[1]], place_[t[2]]};
    Piece* in[] = {pieceAt(places[0]), pieceAt(places[1]), pieceAt(places[2])};
    const bool inside = in[0] == in[1] && in[1] == in[2];
    if (inside && !in[0]) continue;
    for (int k = 0; k < 3 && !inside; ++k) {
      if (in[k]) in[k]->touch(places[k]);
    }
    Piece* most = in[0] == in[1] || in[0] == in[2] ? in[0] : in[1] == in[2] ? in[1] : nullptr;
    if (most) most->add(t, places);
  }
  std::vector<Block> blocks;
  for (Piece& piece : pieces) blocks.push_back(piece.finish(mesh_, locked_, place_));
  return blocks;
}

}  // namespace merlin::render::reduce
