#include "render/lod/alive_ancestors.h"

#include "daemon/base/simd.h"

namespace merlin::render::lod {
namespace {

void findOneByOne(const CollapseForest& forest, std::uint32_t alive, const std::uint32_t* from,
                  std::size_t count, std::uint32_t* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = forest.aliveAncestor(from[i], alive);
}

// Goes up from eight corners at a time, until all eight nodes are alive. This is faster than a loop
// over single corners, whose branches are mispredicted because the number of steps to an alive
// ancestor varies. REQUIRES: node numbers below 2^31.
MERLIN_WIDE void findEightAtOnce(const CollapseForest& forest, std::uint32_t alive,
                                 const std::uint32_t* from, std::size_t count, std::uint32_t* out) {
  const simd::Ints last_alive = simd::all(alive - 1), last = simd::all(forest.nodes - 1);
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    simd::Ints node = simd::load(from + i);
    simd::Ints dead = node > last_alive;
    while (simd::anyWide(dead)) {
      node = simd::gather(forest.parents.data(), (last - node) >> 1, dead, node);
      dead = node > last_alive;
    }
    simd::store(out + i, node);
  }
  findOneByOne(forest, alive, from + i, count - i, out + i);
}

}  // namespace

FindAliveAncestors portableAliveAncestorFinder() { return findOneByOne; }

FindAliveAncestors aliveAncestorFinder(std::size_t nodes) {
  if (nodes > (std::size_t{1} << 31)) return findOneByOne;
  return simd::pick(findEightAtOnce, findOneByOne);
}

}  // namespace merlin::render::lod
