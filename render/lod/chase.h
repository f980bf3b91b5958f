// Finds the nearest alive ancestors of nodes in a dendrogram ("chases" nodes up their parents).
// Private to render/lod.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render::lod {

struct Forest {
  std::span<const std::uint32_t> parents;  // [k]: the node that collapse k makes
  std::uint32_t nodes;

  std::uint32_t parentOf(std::uint32_t node) const noexcept {
    return parents[(nodes - 1 - node) / 2];
  }
  // `node` or its nearest ancestor with a number below `alive`; such nodes are alive.
  std::uint32_t chase(std::uint32_t node, std::uint32_t alive) const noexcept {
    while (node >= alive) node = parentOf(node);
    return node;
  }
};

// Writes the nearest alive ancestor of each of `count` corners to `out`; `from` and `out` may be
// the same array. Processes eight corners at a time if the processor has AVX2, with the same
// result.
using ChaseAll = void (*)(const Forest& forest, std::uint32_t alive, const std::uint32_t* from,
                          std::size_t count, std::uint32_t* out);
ChaseAll chaser(std::size_t nodes);  // the fastest for this processor and so many nodes
ChaseAll portableChaser();           // for tests

}  // namespace merlin::render::lod
