// Finds the nearest alive ancestors of nodes in a dendrogram. Private to render/lod.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::lod {

// The parents of a dendrogram's nodes. Nodes are numbered by the collapse that merges them
// (dendrogram.h).
struct CollapseForest {
  std::span<const std::uint32_t> parents;  // parents[k]: the node that collapse k makes
  std::uint32_t nodes;

  std::uint32_t parentOf(std::uint32_t node) const noexcept {
    return parents[(nodes - 1 - node) / 2];
  }
  // Returns `node` or its nearest ancestor whose number is below `alive`; nodes with such numbers
  // are alive.
  std::uint32_t aliveAncestor(std::uint32_t node, std::uint32_t alive) const noexcept {
    while (node >= alive) node = parentOf(node);
    return node;
  }
};

// Function type: writes the nearest alive ancestor of each of `count` corners in `from` to `out`.
// `from` and `out` may be the same array.
using FindAliveAncestors = void (*)(const CollapseForest& forest, std::uint32_t alive,
                                    const std::uint32_t* from, std::size_t count,
                                    std::uint32_t* out);

// Returns the fastest implementation for this processor and this number of nodes. All
// implementations give the same result.
FindAliveAncestors aliveAncestorFinder(std::size_t nodes);

// For tests: returns the implementation that runs on any processor.
FindAliveAncestors portableAliveAncestorFinder();

}  // namespace merlin::render::lod
