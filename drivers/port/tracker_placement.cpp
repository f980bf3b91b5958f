#include "drivers/port/tracker_placement.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/settings_visitor.h"

namespace merlin {
namespace {

using Vector = std::array<float, 3>;

Vector along(const std::array<int, 3>& axes, const Vector& v) {
  Vector placed{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float value = v[static_cast<std::size_t>(std::abs(axes[i]) - 1)];
    placed[i] = axes[i] < 0 ? -value : value;
  }
  return placed;
}

// 1 or -1: whether the axes are right-handed.
float handedness(const std::array<int, 3>& axes) {
  const Vector x = along(axes, {1, 0, 0}), y = along(axes, {0, 1, 0}), z = along(axes, {0, 0, 1});
  const Vector cross = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                        x[0] * y[1] - x[1] * y[0]};
  return cross[0] * z[0] + cross[1] * z[1] + cross[2] * z[2];
}

}  // namespace

void place(const TrackerPlacement& placement, TrackerSample& sample) noexcept {
  auto& p = sample.position_m;
  auto& q = sample.orientation_wxyz;
  const Vector position = along(placement.axes, {p[0], p[1], p[2]});
  const Vector axis = along(placement.axes, {q[1], q[2], q[3]});
  const float hand = handedness(placement.axes);
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = position[i] + static_cast<float>(placement.origin_m[i]);
    q[i + 1] = hand * axis[i];
  }
}

void checkPlacement(const TrackerPlacement& placement, const std::string& pointer,
                    SettingFaults& faults) {
  std::array<int, 3> used{};
  for (std::size_t i = 0; i < 3; ++i) used[i] = std::abs(placement.axes[i]);
  std::ranges::sort(used);
  if (used == std::array{1, 2, 3}) return;
  faults.push_back({pointer + "/axes",
                    fmt::format("is {}; needed is each of 1, 2 and 3 once, with or without a minus",
                                fmt::join(placement.axes, ", "))});
}

void describe(TrackerPlacement& placement, SettingsVisitor& v) {
  v.numbers(
      "axes", placement.axes, {-3, 3},
      "Which of the axes that are sent are the tracker's x, y and z, as /wall/scene has them "
      "of all trackers: 1 is x, 2 is y, 3 is z; a negative number reverses the axis. For x to "
      "the right, y up and z towards the person, as most motion capture and VR systems send "
      "them, beside a Fastrak: [3, -1, -2].");
  v.numbers("origin_m", placement.origin_m, {-100, 100},
            "Place of the origin that is sent, in metres along the tracker's x, y and z.");
}

}  // namespace merlin
