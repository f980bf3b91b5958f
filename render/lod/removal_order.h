// RemovalOrder: the numbers that the nodes and triangles of a reduction have in its dendrogram,
// which sorts both by the collapse that removes them. It copies neither nodes nor triangles, so
// that a model too large to be copied in memory can be written row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/huge_array.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"

namespace merlin::render::lod {

// Keeps a reference to the log, which must outlive it. O(n), on `threads` threads; the result does
// not depend on their number. Memory: 4 bytes for each node, each triangle and each level; 4 more
// per triangle and 8 per vertex during construction. REQUIRES: as buildDendrogram(); threads > 0.
class RemovalOrder {
 public:
  RemovalOrder(const mesh::Mesh& mesh, const CollapseLog& log, unsigned threads);

  std::size_t nodeCount() const noexcept { return numbers_.size(); }
  std::size_t collapses() const noexcept { return log_.children.size(); }

  // numberOf() converts a node of the log to its number in the dendrogram; nodeOf() converts it
  // back.
  std::uint32_t numberOf(std::size_t node) const noexcept { return numbers_[node]; }
  std::uint32_t nodeOf(std::size_t number) const noexcept {
    if (number < roots_.size()) return roots_[number];
    const std::size_t from_end = numbers_.size() - 1 - number;
    return log_.children[from_end / 2][from_end % 2];
  }

  // Returns the index in the mesh of triangle `i` of the dendrogram.
  std::uint32_t triangleOf(std::size_t i) const noexcept { return triangles_[i]; }

  // Returns the number of triangles left after `level` collapses.
  std::uint32_t aliveAt(std::size_t level) const noexcept { return alive_[level + 1]; }

 private:
  void numberNodes();
  void findRemovals(const mesh::Mesh& mesh, unsigned threads, HugeArray<std::uint32_t>& removals);
  void sortTriangles(const HugeArray<std::uint32_t>& removals);

  const CollapseLog& log_;
  HugeArray<std::uint32_t> numbers_, triangles_;
  HugeArray<std::uint32_t> alive_;  // entry L + 1: triangles left at level L
  std::vector<std::uint32_t> roots_;
};

// Returns the error of each level (log.error.size() + 1 values): the largest error of the collapses
// before the level, so it never decreases.
std::vector<float> risingError(const CollapseLog& log);

}  // namespace merlin::render::lod
