#include "nn/gesture/path_recording.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::nn {
namespace {

constexpr std::int64_t kSessionGap_ns = 500'000'000;

// Returns the index of the take that overlaps at least half of the stroke's time. Since a recording
// may have as many takes as poses, the takes, which are in order of time, are searched by
// bisection.
std::optional<std::size_t> takeOf(const std::vector<Take>& takes, std::int64_t first_ns,
                                  std::int64_t last_ns) {
  auto take = std::partition_point(takes.begin(), takes.end(),
                                   [&](const Take& t) { return t.last_ns < first_ns; });
  for (; take != takes.end() && take->first_ns <= last_ns; ++take) {
    const std::int64_t shared =
        std::min(last_ns, take->last_ns) - std::max(first_ns, take->first_ns);
    if (2 * shared >= last_ns - first_ns) return static_cast<std::size_t>(take - takes.begin());
  }
  return std::nullopt;
}

// Returns whether a stroke that began at `first_ns` began less than `after_s` after the end of a
// take. Only the last take that began before is checked: takes do not overlap, so it also ended
// last.
bool isJustAfter(const std::vector<Take>& takes, std::int64_t first_ns, double after_s) {
  const auto later = std::partition_point(takes.begin(), takes.end(),
                                          [&](const Take& t) { return t.first_ns < first_ns; });
  return later != takes.begin() &&
         static_cast<double>(first_ns - std::prev(later)->last_ns) < after_s * 1e9;
}

// Returns the logarithm of length times greatest speed; both features are logarithms.
float greatness(const StrokeFeatures& stroke) { return stroke[kLogLength] + stroke[kLogSpeed]; }

// Movement of a hand, translation and roll combined as in PathPoint::speed_m_s.
struct Movement {
  float reach_m = 0;  // distance from the hand's first pose
  float greatest_m_s = 0;
};

Movement movementOf(std::span<const LabelledPose> poses) {
  Movement movement;
  StrokeFinder finder;
  std::optional<PathPoint> first;
  for (const LabelledPose& p : poses) {
    (void)finder.update(p.pose);
    const PathPoint& now = finder.newest();
    if (!first) first = now;
    const auto& a = first->position_m;
    const auto& b = now.position_m;
    const float way = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const float turn = kRollLever_m * (now.roll_rad - first->roll_rad);
    movement.reach_m = std::max(movement.reach_m, std::hypot(way, turn));
    movement.greatest_m_s = std::max(movement.greatest_m_s, now.speed_m_s);
  }
  return movement;
}

}  // namespace

std::uint32_t PathRecording::labelled(std::string_view name) {
  const auto found = std::find(labels.begin(), labels.end(), name);
  if (found != labels.end()) return static_cast<std::uint32_t>(found - labels.begin());
  labels.emplace_back(name);
  return static_cast<std::uint32_t>(labels.size() - 1);
}

std::vector<std::span<const LabelledPose>> sessionsOf(const PathRecording& recording) {
  const std::span<const LabelledPose> all(recording.poses);
  std::vector<std::span<const LabelledPose>> sessions;
  std::size_t first = 0;
  for (std::size_t n = 1; n <= all.size(); ++n) {
    const std::int64_t step = n < all.size() ? all[n].pose.at_ns - all[n - 1].pose.at_ns : -1;
    if (step >= 0 && step <= kSessionGap_ns) continue;
    sessions.push_back(all.subspan(first, n - first));
    first = n;
  }
  return sessions;
}

std::vector<Take> takesOf(std::span<const LabelledPose> session, const PathRecording& recording) {
  std::vector<Take> takes;
  bool open = false;
  for (const LabelledPose& p : session) {
    const bool none = recording.labels[p.label] == kNoGesture;
    if (open && !none && takes.back().label == p.label) {
      takes.back().last_ns = p.pose.at_ns;
      continue;
    }
    open = !none;
    if (open) takes.push_back({p.label, p.pose.at_ns, p.pose.at_ns});
  }
  return takes;
}

std::vector<LabelledStroke> strokesOf(const PathRecording& recording, double after_take_s,
                                      std::size_t& lost) {
  std::vector<LabelledStroke> strokes;
  lost = 0;
  for (const auto session : sessionsOf(recording)) {
    const std::vector<Take> takes = takesOf(session, recording);
    std::vector<std::optional<StrokeFeatures>> greatest(takes.size());
    StrokeFinder finder;
    UsualPace pace;
    for (const LabelledPose& p : session) {
      const auto stroke = finder.update(p.pose);
      if (stroke.empty()) continue;
      const auto features = featuresOf(stroke, finder.calmBefore_m_s(), pace);
      if (!features) continue;
      const std::int64_t first_ns = stroke.front().at_ns;
      if (const auto take = takeOf(takes, first_ns, stroke.back().at_ns)) {
        auto& best = greatest[*take];
        if (!best || greatness(*features) > greatness(*best)) best = features;
      } else if (!isJustAfter(takes, first_ns, after_take_s)) {
        strokes.push_back({std::string(kNoGesture), *features});
        pace.learn((*features)[kLogLength], (*features)[kLogSpeed], (*features)[kRoll]);
      }
    }
    for (std::size_t n = 0; n < takes.size(); ++n) {
      if (greatest[n]) strokes.push_back({recording.labels[takes[n].label], *greatest[n]});
      if (!greatest[n]) ++lost;
    }
  }
  return strokes;
}

Result<Ok> checkTake(const PathRecording& take) {
  std::size_t lost = 0;
  (void)strokesOf(take, 0, lost);
  if (lost == 0) return Ok{};
  const Movement m = movementOf(take.poses);
  return Error{
      Errc::kInvalidArgument,
      fmt::format(
          "the hand made no stroke: it moved {:.0f} cm, at most {:.2f} m/s, its turn "
          "included; make the gesture once, faster than {} m/s, and begin and end it within "
          "the take",
          100 * m.reach_m, m.greatest_m_s, StrokeSettings{}.begins_m_s)};
}

}  // namespace merlin::nn
