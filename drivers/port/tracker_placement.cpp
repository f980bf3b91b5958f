#include "drivers/port/tracker_placement.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

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

// Returns 1 if the axes are right-handed, otherwise -1.
float handedness(const std::array<int, 3>& axes) {
  const Vector x = along(axes, {1, 0, 0}), y = along(axes, {0, 1, 0}), z = along(axes, {0, 0, 1});
  const Vector cross = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                        x[0] * y[1] - x[1] * y[0]};
  return cross[0] * z[0] + cross[1] * z[1] + cross[2] * z[2];
}

constexpr double kMostOff_deg = 20;

// Returns the tracker's axis that is nearest to the direction from `origin` to `to`: 1 to 3,
// negative if it points the opposite way.
Result<int> nearestAxis(const std::array<double, 3>& origin, const std::array<double, 3>& to,
                        const char* name) {
  std::array<double, 3> way{};
  for (std::size_t i = 0; i < 3; ++i) way[i] = to[i] - origin[i];
  const auto longest = std::ranges::max_element(way, {}, [](double v) { return std::abs(v); });
  const double length = std::hypot(way[0], way[1], way[2]);
  const double off_deg =
      std::acos(std::min(std::abs(*longest) / length, 1.0)) * 180 / std::numbers::pi;
  const int axis = static_cast<int>(longest - way.begin()) + 1;
  if (off_deg <= kMostOff_deg) return *longest < 0 ? -axis : axis;
  return Error{
      Errc::kMalformed,
      fmt::format("the {} axis lies {:.0f} degrees off the nearest axis that is sent ({} are "
                  "allowed): hold the station more exactly, or turn the axes in the "
                  "tracker's server",
                  name, off_deg, kMostOff_deg)};
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

Result<TrackerPlacement> placementOf(const std::array<double, 3>& origin,
                                     const std::array<double, 3>& on_x,
                                     const std::array<double, 3>& on_y) {
  TrackerPlacement solved;
  const std::pair<const char*, const std::array<double, 3>*> ways[] = {{"x", &on_x}, {"y", &on_y}};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = nearestAxis(origin, *ways[i].second, ways[i].first);
    if (!axis) return axis.error();
    solved.axes[i] = *axis;
  }
  if (std::abs(solved.axes[0]) == std::abs(solved.axes[1]))
    return Error{Errc::kMalformed,
                 fmt::format("the x axis and the y axis both lie along the axis {} that is sent",
                             std::abs(solved.axes[0]))};
  solved.axes[2] = 6 - std::abs(solved.axes[0]) - std::abs(solved.axes[1]);
  if (handedness(solved.axes) < 0) solved.axes[2] = -solved.axes[2];
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = origin[static_cast<std::size_t>(std::abs(solved.axes[i]) - 1)];
    solved.origin_m[i] = solved.axes[i] < 0 ? at : -at;
  }
  return solved;
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
      "Axes of the sender that become the tracker's x, y and z: 1 is x, 2 is y, 3 is z; a negative "
      "number reverses the axis. /wall/scene/tracker_axes then applies to the result, as it does "
      "to all trackers. For a sender with x to the right, y up and z towards the person, as most "
      "motion capture and VR systems have it, used together with a Fastrak: [3, -1, -2].");
  v.numbers("origin_m", placement.origin_m, {-100, 100},
            "Position, in the tracker's frame, of the sender's origin (the point 0, 0, 0): x, y, z "
            "in metres.");
}

}  // namespace merlin
