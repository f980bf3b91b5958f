#include "drivers/spaceball/settings.h"

#include <cstdlib>
#include <set>

#include <fmt/format.h>

namespace merlin {

SettingFaults validate(const SpaceballSettings& ball) {
  std::set<int> seen;
  for (const int axis : ball.axis_map) seen.insert(std::abs(axis));
  if (seen.size() == ball.axis_map.size() && seen.count(0) == 0 && *seen.rbegin() == 6) return {};
  return {{"/axis_map", fmt::format("is {}; allowed is each of 1 to {} once, any of them negative",
                                    fmt::join(ball.axis_map, ", "), ball.axis_map.size())}};
}

}  // namespace merlin
