#include "drivers/port/axes.h"

#include <cmath>
#include <cstdlib>
#include <set>

#include <fmt/format.h>

namespace merlin {

void fillAxes(const std::array<float, 6>& deflections, float dead_zone, float curve,
              BallSample& sample) noexcept {
  constexpr float kRawScale = 1000;
  for (std::size_t i = 0; i < deflections.size(); ++i) {
    const float share = axisShare(deflections[i], dead_zone, 1);
    const float value = std::pow(std::abs(share), curve);
    (i < 3 ? sample.translation[i] : sample.rotation[i - 3]) = share < 0 ? -value : value;
    const float raw = i % 3 == 2 ? -deflections[i] : deflections[i];  // a Spaceball's z
    sample.raw[i] = static_cast<std::int16_t>(std::lround(raw * kRawScale));
  }
}

SettingFaults validateAxisMap(const AxisMap& map) {
  std::set<int> seen;
  for (const int axis : map) seen.insert(std::abs(axis));
  if (seen.size() == map.size() && seen.count(0) == 0 && *seen.rbegin() == 6) return {};
  return {{"/axis_map",
           fmt::format("is {}; allowed is each of 1 to {} once, each with or without a minus",
                       fmt::join(map, ", "), map.size())}};
}

}  // namespace merlin
