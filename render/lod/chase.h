// Corners up their parents to the nodes that are alive. Private to render/lod.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace merlin::render {

struct Forest {
  std::span<const std::uint32_t> parents;  // as Dendrogram has them
  std::uint32_t nodes;

  std::uint32_t parentOf(std::uint32_t node) const noexcept {
    return parents[(nodes - 1 - node) / 2];
  }
  // The first of `node` and its ancestors with a number below `alive`.
  std::uint32_t chase(std::uint32_t node, std::uint32_t alive) const noexcept {
    while (node >= alive) node = parentOf(node);
    return node;
  }
};

// Follows each of `count` corners to its surviving ancestor; `from` and `out` may be the same
// array. Uses eight lanes where the processor can (AVX2), with the same result.
using ChaseAll = void (*)(const Forest& forest, std::uint32_t alive, const std::uint32_t* from,
                          std::size_t count, std::uint32_t* out);
ChaseAll chaser(std::size_t nodes);  // the fastest for this processor and so many nodes
ChaseAll portableChaser();           // for tests

}  // namespace merlin::render
