#include "daemon/wall/wall_loop.h"

#include <algorithm>
#include <utility>

namespace merlin::wall {
namespace {

// Left free at the end of a period that is spent on refining.
constexpr Duration kRefineMargin = std::chrono::milliseconds(2);
// Left for reading the last tile back and handing the frame to the sinks.
constexpr Duration kPresentMargin = std::chrono::milliseconds(3);
constexpr Duration kMinute = std::chrono::seconds(60);
constexpr Duration kSecond = std::chrono::seconds(1);

float ms(Duration d) { return static_cast<float>(1000 * toSeconds(d)); }

}  // namespace

WallLoop::WallLoop(WallParts parts)
    : p_(std::move(parts)), period_(p_.governor.period()), view_(p_.scene.view()) {}

void WallLoop::run(const std::stop_token& stop, const std::function<void()>& first_frame) {
  start_ = p_.clock.now();
  for (std::int64_t k = 0; p_.clock.sleepUntil(tick(k), stop);) {
    const Timestamp began = p_.clock.now();
    obeyRequests();
    const render::SceneInput input = p_.feed.read(began);
    const bool was_moving = view_.moving;
    view_ = p_.scene.update(input, began);
    std::fill(std::begin(out_.posture), std::end(out_.posture), '\0');
    if (input.posture)
      std::copy(std::begin(input.posture->name), std::end(input.posture->name), out_.posture);
    if (was_moving && !view_.moving) still_since_ = began;
    if (!was_moving && view_.moving) resuming_ = true;
    k = view_.moving ? movingFrame(k, began) : stillPeriod(k);
    publishStats(p_.clock.now());
    if (periods_.fetch_add(1, std::memory_order_relaxed) == 0) first_frame();
  }
}

void WallLoop::obeyRequests() {
  const std::uint32_t requests = requests_.exchange(0);
  if (requests & kResetView) p_.scene.reset();
  if (requests & kNextMode) p_.scene.nextMode();
}

std::int64_t WallLoop::movingFrame(std::int64_t k, Timestamp began) {
  // After a frame that ran over, less than a period is left: fewer triangles, or none before the
  // next.
  const std::size_t budget = p_.governor.budgetFor(tick(k + 1) - began);
  if (budget == 0) {
    stats_.deadline(tick(k + 1), true, false);
    return k + 1;
  }
  level_ = p_.model.levelFor(budget);
  const DrawTimes times = p_.painter.draw(view_.T_eye_model, level_, tick(k + 1) - kPresentMargin);
  const Timestamp drawn = p_.clock.now();
  present(level_ == 0);
  const Timestamp finished = p_.clock.now();
  const Duration work = finished - began;
  refining_ = false;

  // A frame that ran over more than its own deadline missed those too.
  const std::int64_t reached = (finished - start_) / period_;
  const bool met = finished <= tick(k + 1);
  stats_.deadline(tick(k + 1), true, met);
  for (std::int64_t missed = k + 2; missed <= reached; ++missed)
    stats_.deadline(tick(missed), true, false);
  stats_.frame(finished, work, period_);
  // What the frame would have cost with every view as fine as the wall.
  const Duration fixed = times.fixed + (finished - drawn);
  p_.governor.observe({p_.model.trianglesAt(level_), fixed, fixed + times.drawing, !met});
  out_.work_ms = ms(work);
  if (resuming_) {
    ++out_.resumed;
    out_.resumed_late += met ? 0 : 1;
    resuming_ = false;
  }
  return std::max(k + 1, reached);
}

std::int64_t WallLoop::stillPeriod(std::int64_t k) {
  if (!full_detail_) {
    if (!refining_) p_.painter.beginRefining(view_.T_eye_model);
    refining_ = !p_.painter.refine(tick(k + 1) - kRefineMargin);
    if (!refining_) {
      level_ = 0;
      present(true);
      out_.still_to_full_s = static_cast<float>(toSeconds(p_.clock.now() - still_since_));
    }
  }
  // What stands is right: the deadline is met, unless refining ran over it.
  const std::int64_t reached = (p_.clock.now() - start_) / period_;
  for (std::int64_t passed = k + 1; passed <= std::max(k + 1, reached); ++passed)
    stats_.deadline(tick(passed), false, true);
  return std::max(k + 1, reached);
}

void WallLoop::present(bool full_detail) {
  full_detail_ = full_detail;
  const auto triangles = static_cast<std::uint32_t>(p_.model.trianglesAt(level_));
  const render::FrameInfo info{++frames_, p_.clock.now(), triangles, full_detail};
  for (render::FrameSink* sink : p_.sinks) sink->present(p_.painter.pixels(), info);
}

void WallLoop::publishStats(Timestamp now) {
  stats_.advance(now);
  out_.updated_ns = toNanoseconds(now);
  out_.frames = frames_;
  out_.deadlines = stats_.deadlines();
  out_.late = stats_.late();
  out_.triangles = static_cast<std::uint32_t>(p_.model.trianglesAt(level_));
  out_.level = static_cast<std::uint32_t>(level_);
  out_.levels = static_cast<std::uint32_t>(p_.model.levels());
  out_.moving = view_.moving;
  out_.full_detail = full_detail_;
  out_.longest_late = stats_.longestLate();
  out_.rate_asked_hz = static_cast<float>(1 / toSeconds(period_));
  out_.rate_held_hz = static_cast<float>(stats_.heldRate(now, 1 / toSeconds(period_)));
  out_.late_share_1s = static_cast<float>(stats_.lateShare(now, kSecond));
  out_.late_share_1min = static_cast<float>(stats_.lateShare(now, kMinute));
  const double all = static_cast<double>(std::max<std::uint64_t>(stats_.deadlines(), 1));
  out_.late_share = static_cast<float>(static_cast<double>(stats_.late()) / all);
  out_.work_median_ms = static_cast<float>(1000 * stats_.medianWorkSeconds());
  out_.utilisation = static_cast<float>(stats_.utilisation());
  out_.head_room = static_cast<float>(p_.governor.headRoom());
  out_.cost_fixed_ms = static_cast<float>(1000 * p_.governor.fixedSeconds());
  out_.cost_coefficient_us = static_cast<float>(1e6 * p_.governor.coefficient());
  out_.input_age_ms = ms(p_.feed.age());
  out_.grabbed = view_.grabbed;
  const std::string_view mode = view_.mode == render::BallMode::kFly ? "fly" : "object";
  std::fill(std::begin(out_.mode), std::end(out_.mode), '\0');
  std::copy(mode.begin(), mode.end(), out_.mode);
  p_.stats.publish(out_);
}

}  // namespace merlin::wall
