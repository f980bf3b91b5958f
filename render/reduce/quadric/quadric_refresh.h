// Functions that process all living vertices in parallel. Private to render/reduce.
#pragma once

#include <algorithm>
#include <cstdint>

#include "render/reduce/quadric/reduction_state.h"

namespace merlin::render::reduce {

// Calls work(v, scratch) for each living vertex v, in parallel on state.threads. The signature is
// work(std::uint32_t, EdgeCosts&); it may write only data of v and of its scratch.
template <typename Work>
void forEachLiving(const ReductionState& state, const Work& work) {
  constexpr std::size_t kBlock = 1 << 12;
  const std::size_t n = state.mesh.vertexCount();
  forBlocks(state.threads, (n + kBlock - 1) / kBlock, [&](std::size_t block) {
    EdgeCosts scratch;
    const auto end = static_cast<std::uint32_t>(std::min(n, (block + 1) * kBlock));
    for (auto v = static_cast<std::uint32_t>(block * kBlock); v < end; ++v) {
      if (lives(state.mesh[v])) work(v, scratch);
    }
  });
}

// Recomputes the quadrics of all living vertices. A vertex with more than rules.most_corners
// triangles becomes a hub, which has no quadric; since the cost of an edge needs the quadrics of
// both ends, hubs do not take part in collapses.
void refreshQuadrics(ReductionState& state);

}  // namespace merlin::render::reduce
