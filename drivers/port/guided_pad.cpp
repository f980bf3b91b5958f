#include "drivers/port/guided_pad.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr GuidedStep kPadSteps[] = {
    {"rest", "take your hands off it"},
    {"right",
     "move what is to move the model to the right, as far as it goes, and hold it there; "
     "if nothing is moved, the model cannot be moved this way"},
    {"up", "the same for up"},
    {"towards you", "the same for towards you"},
    {"tilt", "the same for a turn of the model that brings its top towards you"},
    {"turn", "the same for a turn that brings its front to the right"},
    {"roll", "the same for a turn that brings its top to the left"},
};
constexpr std::size_t kRest = 0;

constexpr float kNothing = 0.15F;  // a smaller change counts as not intended
constexpr float kLeast = 0.5F;     // least change that is accepted as an answer
// Limit of the second strongest change, share of the strongest.
constexpr float kMostNext = 0.6F;
constexpr float kMostNoise = 0.2F;    // largest accepted motion of an axis at rest
constexpr float kTriggerRest = 0.6F;  // an axis that rests farther from the middle is a trigger
constexpr double kLeastDeadZone = 0.05, kMostDeadZone = 0.5;  // sticks seldom return exactly

}  // namespace

std::span<const GuidedStep> padSteps() { return kPadSteps; }

bool GuidedPad::Axis::isTrigger() const noexcept { return std::abs(rest()) > kTriggerRest; }

void GuidedPad::begin(std::size_t step) {
  step_ = step;
  if (step == kRest) axes_.clear();
  for (auto& [name, axis] : axes_) axis.strongest = 0;
}

void GuidedPad::add(std::span<const AxisReading> readings) {
  for (const AxisReading& reading : readings) {
    const auto [at, is_new] = axes_.try_emplace(reading.name);
    Axis& axis = at->second;
    if (step_ == kRest) {
      axis.low = is_new ? reading.deflection : std::min(axis.low, reading.deflection);
      axis.high = is_new ? reading.deflection : std::max(axis.high, reading.deflection);
    }
    const float change = reading.deflection - axis.rest();
    if (std::abs(change) > std::abs(axis.strongest)) axis.strongest = change;
  }
}

Result<PadAnswer> GuidedPad::end() {
  answers_[step_] = {};
  if (step_ == kRest) return endRest();
  std::vector<const std::pair<const std::string, Axis>*> all;
  for (const auto& axis : axes_) all.push_back(&axis);
  std::ranges::stable_sort(all, std::ranges::greater{},
                           [](const auto* axis) { return std::abs(axis->second.strongest); });
  if (all.empty() || std::abs(all[0]->second.strongest) < kNothing) return answers_[step_];
  const auto& [name, axis] = *all[0];
  const float change = std::abs(axis.strongest);
  if (change < kLeast)
    return Error{Errc::kMalformed, fmt::format("{} moved the most, by {:.2f} ({} are needed): move "
                                               "it further",
                                               name, change, kLeast)};
  if (all.size() > 1 && std::abs(all[1]->second.strongest) > kMostNext * change)
    return Error{Errc::kMalformed,
                 fmt::format("two axes moved alike, {} by {:.2f} and {} by {:.2f}: move one only",
                             name, change, all[1]->first, std::abs(all[1]->second.strongest))};
  const auto source = sourceOf(name, axis);
  if (!source) return source.error();
  if (const auto unused = checkUnused(*source); !unused) return unused.error();
  answers_[step_] = {*source, axis.strongest};
  return answers_[step_];
}

Result<PadAnswer> GuidedPad::endRest() const {
  PadAnswer restless;
  for (const auto& [name, axis] : axes_) {
    const float noise = (axis.high - axis.low) / 2;
    if (noise > restless.deflection) restless = {name, noise};
  }
  if (restless.deflection <= kMostNoise) return restless;
  return Error{Errc::kMalformed,
               fmt::format("{} moved by {:.2f} ({} are taken for noise): was it touched?",
                           restless.source, restless.deflection, kMostNoise)};
}

Result<std::string> GuidedPad::sourceOf(const std::string& name, const Axis& axis) const {
  if (!axis.isTrigger()) return (axis.strongest < 0 ? "-" : "") + name;
  std::vector<std::string> others;
  for (const auto& [other, its] : axes_) {
    if (other != name && its.isTrigger() && (its.rest() < 0) == (axis.rest() < 0))
      others.push_back(other);
  }
  // The first name is the axis that deflects the pair in the positive direction when it rises from
  // the lower end of its range.
  if (others.size() == 1)
    return axis.rest() < 0 ? fmt::format("{}-{}", name, others[0])
                           : fmt::format("{}-{}", others[0], name);
  return Error{Errc::kMalformed,
               fmt::format("{} is a trigger, which rests at its end and needs another one that "
                           "pulls the other way: {}; move something else, or give --axes",
                           name, others.empty() ? "there is none" : "there are several")};
}

Result<Ok> GuidedPad::checkUnused(const std::string& source) const {
  const auto namesOf = [](const std::string& text) {
    std::vector<std::string> names;
    std::string name;
    for (const char c : text + "-") {
      if (c != '-')
        name += c;
      else if (!name.empty())
        names.push_back(std::exchange(name, ""));
    }
    return names;
  };
  const auto names = namesOf(source);
  for (std::size_t before = kRest + 1; before < step_; ++before) {
    for (const std::string& used : namesOf(answers_[before].source)) {
      if (std::ranges::find(names, used) == names.end()) continue;
      return Error{Errc::kMalformed, fmt::format("{} answered, as it did to \"{}\": move something "
                                                 "else, or nothing",
                                                 used, kPadSteps[before].name)};
    }
  }
  return Ok{};
}

std::optional<PadAxes> GuidedPad::solve() const {
  PadAxes solved;
  for (std::size_t step = kRest + 1; step < answers_.size(); ++step)
    solved.axes.push_back(answers_[step].source);
  if (std::ranges::count(solved.axes, "none") == 6) return std::nullopt;
  double restless = 0;
  for (const auto& [name, axis] : axes_) {
    if (!axis.isTrigger())
      restless = std::max<double>(restless, std::max(std::abs(axis.low), std::abs(axis.high)));
  }
  const double zone = std::clamp(1.5 * restless + 0.02, kLeastDeadZone, kMostDeadZone);
  solved.dead_zone = std::round(100 * zone) / 100;
  return solved;
}

}  // namespace merlin
