// usefulCost: converts a budget of detail to the number that people are shown.
#pragma once

#include <algorithm>
#include <cstdint>

#include "daemon/shm/layout.h"

namespace merlin::wall {

// Returns `cost`, but at most the cost of full detail, since the governor's budget may be far
// higher than a small picture can use. While the cost of full detail is unknown (0), returns
// `cost`. Both are in WallStats::cost_unit.
inline std::uint32_t usefulCost(const shm::WallStats& stats, std::uint32_t cost) {
  return stats.full_cost > 0 ? std::min(cost, stats.full_cost) : cost;
}

}  // namespace merlin::wall
