#include "drivers/port/axes.h"

#include <cstdlib>
#include <set>

#include <fmt/format.h>

namespace merlin {

SettingFaults validateAxisMap(const AxisMap& map) {
  std::set<int> seen;
  for (const int axis : map) seen.insert(std::abs(axis));
  if (seen.size() == map.size() && seen.count(0) == 0 && *seen.rbegin() == 6) return {};
  return {{"/axis_map", fmt::format("is {}; allowed is each of 1 to {} once, any of them negative",
                                    fmt::join(map, ", "), map.size())}};
}

}  // namespace merlin
