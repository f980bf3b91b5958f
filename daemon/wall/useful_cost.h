// usefulCost: a budget of detail as people read it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "daemon/shm/layout.h"

namespace merlin::wall {

// The part of a cost that the content can use: no more than full detail costs, since the governor's
// budget goes far beyond that of a small picture. While the cost of full detail is unknown, returns
// `cost`.
inline std::uint32_t usefulCost(const shm::WallStats& stats, std::uint32_t cost) {
  return stats.full_cost > 0 ? std::min(cost, stats.full_cost) : cost;
}

}  // namespace merlin::wall
