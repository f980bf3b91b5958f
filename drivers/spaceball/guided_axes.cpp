#include "drivers/spaceball/guided_axes.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace merlin::spaceball {
namespace {

constexpr GuidedStep kSteps[] = {
    {"rest", "take your hands off the ball"},
    {"right", "push it to the right, as hard as you ever will, and hold it there"},
    {"up", "pull it up, as hard as you ever will, and hold it there"},
    {"towards you", "pull it towards you, as hard as you ever will, and hold it there"},
    {"tilt", "twist it so that its top comes towards you, as far as you ever will, and hold it"},
    {"turn", "twist it so that its front goes to the right, as far as you ever will, and hold it"},
    {"roll", "twist it so that its top goes to the left, as far as you ever will, and hold it"},
};
constexpr std::size_t kRest = 0;

// Limit of the second axis of a kind, relative to the first.
constexpr int kMostNext_percent = 60;
constexpr int kMargin = 4;                      // counts, added to the dead zone
constexpr int kMostNoise = (99 - kMargin) / 2;  // keeps the dead zone within 0..99

constexpr bool isPush(std::size_t step) { return step <= 3; }
constexpr bool isPushAxis(int axis) { return std::abs(axis) <= 3; }
constexpr int deadZone(int noise) { return 2 * noise + kMargin; }

}  // namespace

std::span<const GuidedStep> axesSteps() { return kSteps; }

char nameOfAxis(int axis) noexcept {
  return std::string_view("-XYZABC")[static_cast<std::size_t>(std::abs(axis))];
}

// Returns the counts of a push unchanged, those of a twist scaled to a push.
int GuidedAxes::strength(int axis, int counts) const noexcept {
  return counts * (isPushAxis(axis) ? 1 : response_.push_of_twist);
}

void GuidedAxes::begin(std::size_t step) {
  step_ = step;
  strongest_ = {};
}

void GuidedAxes::add(const BallSample& sample) {
  for (std::size_t i = 0; i < 6; ++i) {
    if (std::abs(int{sample.raw[i]}) > std::abs(strongest_[i])) strongest_[i] = sample.raw[i];
  }
}

Result<AxisAnswer> GuidedAxes::end() {
  std::array<int, 6> axes = {1, 2, 3, 4, 5, 6};
  const auto counts = [&](int axis) {
    return std::abs(strongest_[static_cast<std::size_t>(axis - 1)]);
  };
  const auto asked = [&](int axis) {  // unscaled in the step "rest"
    return step_ == kRest ? counts(axis) : strength(axis, counts(axis));
  };
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return asked(a) > asked(b); });
  // A push beside the ball's centre also twists it a little, so only axes of one kind are compared.
  const int next = *std::find_if(axes.begin() + 1, axes.end(),
                                 [&](int axis) { return isPushAxis(axis) == isPushAxis(axes[0]); });
  const int sign = strongest_[static_cast<std::size_t>(axes[0] - 1)] < 0 ? -1 : 1;
  const AxisAnswer answer{sign * axes[0], counts(axes[0]), next, counts(next)};
  answers_[step_] = {};
  if (const auto checked = check(answer); !checked) return checked.error();
  answers_[step_] = answer;
  return answer;
}

Result<Ok> GuidedAxes::check(const AxisAnswer& answer) const {
  const auto refuse = [](std::string what) { return Error{Errc::kMalformed, std::move(what)}; };
  const char name = nameOfAxis(answer.axis), next = nameOfAxis(answer.next_axis);
  if (step_ == kRest) {
    if (answer.counts <= kMostNoise) return Ok{};
    return refuse(fmt::format("{} showed {} counts ({} are taken for noise): was it touched?", name,
                              answer.counts, kMostNoise));
  }
  const int least = isPushAxis(answer.axis) ? response_.least_push : response_.least_twist;
  if (answer.counts < least) {
    return refuse(fmt::format("{} answered the most, with {} counts ({} are needed): {} it harder",
                              name, answer.counts, least, isPush(step_) ? "push" : "twist"));
  }
  if (isPush(step_) != isPushAxis(answer.axis)) {
    return refuse(fmt::format("{} answered the most, with {} counts, which is a {}: {} it only",
                              name, answer.counts, isPush(step_) ? "twist" : "push",
                              isPush(step_) ? "push" : "twist"));
  }
  if (100 * answer.next_counts > kMostNext_percent * answer.counts) {
    return refuse(
        fmt::format("two axes answer alike, {} with {} counts and {} with {} ({} % of "
                    "the strongest are allowed): move it one way only",
                    name, answer.counts, next, answer.next_counts, kMostNext_percent));
  }
  for (std::size_t before = kRest + 1; before < step_; ++before) {
    if (std::abs(answers_[before].axis) != std::abs(answer.axis)) continue;
    return refuse(fmt::format("{} answered, as it did to \"{}\": move it another way", name,
                              kSteps[before].name));
  }
  return Ok{};
}

SpaceballSettings GuidedAxes::solve(const SpaceballSettings& settings) const {
  SpaceballSettings solved = settings;
  solved.dead_zone = deadZone(answers_[kRest].counts);
  for (std::size_t i = 0; i < 6; ++i) solved.axis_map[i] = answers_[i + 1].axis;
  const auto full_scale = [&](std::size_t first) {
    const int weakest =
        std::min({answers_[first].counts, answers_[first + 1].counts, answers_[first + 2].counts});
    return std::clamp(weakest * 9 / 10, 100, 32767);
  };
  solved.full_scale_translation = full_scale(1);
  solved.full_scale_rotation = full_scale(4);
  return solved;
}

}  // namespace merlin::spaceball
