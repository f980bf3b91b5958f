// DeathOrder: where the nodes and the triangles of a reduction stand in its dendrogram, without a
// copy of either. Who writes a model that is too large for a copy gathers by it, row for row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/huge_array.h"
#include "render/lod/collapse_log.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// Keeps a reference to the log, which must outlive it. O(n), on `threads` threads with the same
// result; 4 bytes a node, a triangle and a level, 4 more a triangle and 8 a vertex while it is
// made. REQUIRES: as buildDendrogram(); threads > 0.
class DeathOrder {
 public:
  DeathOrder(const Mesh& mesh, const CollapseLog& log, unsigned threads);

  std::size_t nodeCount() const noexcept { return numbers_.size(); }
  std::size_t collapses() const noexcept { return log_.children.size(); }

  // Converts a node of the log to its number in the dendrogram, and back.
  std::uint32_t numberOf(std::size_t node) const noexcept { return numbers_[node]; }
  std::uint32_t nodeOf(std::size_t number) const noexcept {
    if (number < roots_.size()) return roots_[number];
    const std::size_t from_end = numbers_.size() - 1 - number;
    return log_.children[from_end / 2][from_end % 2];
  }

  // The mesh's triangle that is number `i` of the dendrogram.
  std::uint32_t triangleOf(std::size_t i) const noexcept { return triangles_[i]; }

  // Triangles left after `level` collapses.
  std::uint32_t aliveAt(std::size_t level) const noexcept { return alive_[level + 1]; }

 private:
  void numberNodes();
  void findDeaths(const Mesh& mesh, unsigned threads, HugeArray<std::uint32_t>& deaths);
  void sortTriangles(const HugeArray<std::uint32_t>& deaths);

  const CollapseLog& log_;
  HugeArray<std::uint32_t> numbers_, triangles_;
  HugeArray<std::uint32_t> alive_;  // of the level before
  std::vector<std::uint32_t> roots_;
};

// The error of each level: the largest up to it. log.error.size() + 1.
std::vector<float> risingError(const CollapseLog& log);

}  // namespace merlin::render
