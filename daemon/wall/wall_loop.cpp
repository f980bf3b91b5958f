#include "daemon/wall/wall_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::wall {
namespace {

using shm::StepKind;

// Left free at the end of a period that is spent on refining.
constexpr Duration kRefineMargin = std::chrono::milliseconds(2);
// Left for reading the last tile back and handing the frame to the sinks.
constexpr Duration kPresentMargin = std::chrono::milliseconds(3);
// Work of the first finer picture of a still scene: it is out within two periods.
constexpr Duration kFirstRefinement = std::chrono::milliseconds(40);
constexpr std::size_t kNextRefinement = 8;  // times as many triangles
// Share of a period that is used for the first frame after a standstill: cores that slept, and
// caches that hold another picture, are slow at first.
constexpr double kResumingShare = 0.75;
// A level that is this near to the budget stays: what moves does not pop.
constexpr double kSameLevel = 0.04;

}  // namespace

WallLoop::WallLoop(WallParts parts)
    : p_(std::move(parts)),
      asked_hz_(1 / toSeconds(p_.governor.period())),
      configured_hz_(asked_hz_),
      period_(p_.governor.period()),
      view_(p_.scene.view()),
      lost_(p_.return_after_s),
      homes_(p_.contents.size()) {}

void WallLoop::run(const std::stop_token& stop, const std::function<void()>& first_frame) {
  p_.frame_clock.start(p_.clock.now(), period_);
  bool first = true;
  for (std::int64_t k = 0; p_.frame_clock.waitFor(k, stop);) {
    const Timestamp began = p_.clock.now();
    obeyRequests();
    if (applyRate()) {
      p_.frame_clock.start(p_.frame_clock.begin(k), period_);
      k = 0;
    }
    look(k, began);
    k = view_.moving ? movingFrame(k, began) : stillPeriod(k);
    publishTrace(p_.clock.now());
    publishStats(p_.clock.now());
    if (p_.progress) p_.progress->step();
    if (std::exchange(first, false)) first_frame();
    replaceContents();
  }
}

void WallLoop::hold(std::optional<std::size_t> triangles) noexcept {
  hold_.store(triangles ? static_cast<std::int64_t>(*triangles) : -1);
}

void WallLoop::setRate(std::optional<double> rate_hz) noexcept {
  rate_hz_.store(rate_hz.value_or(0));
}

void WallLoop::obeyRequests() {
  const std::uint32_t requests = requests_.exchange(0);
  if (requests & kResetView) returnHome();
  if (requests & kNextMode) p_.scene.nextMode();
  if (requests & kNextContent) nextContent(1);
  const std::int64_t held = hold_.load();
  p_.governor.hold(held < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(held)));
}

// Whether another rate holds from now on.
bool WallLoop::applyRate() {
  const double by_hand = rate_hz_.load();
  asked_hz_ = by_hand > 0 ? by_hand : configured_hz_;
  const double now_hz = asked_hz_ / rateDivisor();
  if (period_ == fromSeconds(1 / now_hz)) return false;
  p_.governor.setRate(now_hz);
  period_ = p_.governor.period();
  return true;
}

void WallLoop::calibrate() {
  std::vector<render::FrameCost> costs;
  const auto fits = [&] { return costs.empty() || costs.back().work <= period_; };
  content_ = 0;
  std::size_t last = detail().steps();
  for (std::size_t cost = detail().leastUseful() * 10 / 3; fits(); cost *= 4) {
    const std::size_t step = detail().stepWithin(cost);
    if (std::exchange(last, step) == step) break;
    for (int i = 0; i < 3 && fits(); ++i) {
      const render::DrawTimes t = draw(step, Timestamp::max());
      costs.push_back({detail().costOf(step), t.fixed, t.fixed + t.drawing, false});
    }
    if (step == 0) break;
  }
  p_.governor.calibrate(costs);
  const std::size_t cost = p_.governor.budget();
  homes_[0] = {cost, p_.governor.predict(cost) - p_.governor.fixedSeconds()};
  for (content_ = 1; content_ < p_.contents.size(); ++content_) measureHome();
  content_ = 0;
}

// Measures this content's start view at the first content's cost. The fastest of three draws
// counts, since the first one warms caches.
void WallLoop::measureHome() {
  const std::size_t step = detail().stepWithin(homes_[0].cost);
  Home& home = homes_[content_];
  home.cost = detail().costOf(step);
  for (int i = 0; i < 3; ++i) {
    const render::DrawTimes t = draw(step, Timestamp::max());
    const double s = toSeconds(t.drawing);
    home.drawing_s = i == 0 ? s : std::min(home.drawing_s, s);
  }
}

// Feed-forward: the start view was measured, so the governor is told its cost ratio before it is
// drawn.
void WallLoop::expectHome() {
  if (scale() > 1) return;  // homes are of full size
  const Home& home = homes_[content_];
  const double now_s = p_.governor.predict(home.cost) - p_.governor.fixedSeconds();
  if (home.drawing_s > 0 && now_s > 0) p_.governor.expect(home.drawing_s / now_s);
}

void WallLoop::returnHome() {
  p_.scene.reset();
  expectHome();
}

// The next content is shown after the scene's update, from its initial view.
void WallLoop::nextContent(std::uint32_t times) {
  next_contents_ += times;
  if (times > 0) p_.scene.reset();
}

void WallLoop::showContent(std::size_t content) {
  content_ = content;
  step_ = detail().steps() - 1;
  moving_step_.reset();
  refining_ = full_detail_ = false;
  expectHome();
}

// The cost of the new content is not known: the governor learns it as it does for any other view.
void WallLoop::replaceContents() {
  if (!p_.replacements) return;
  const auto fresh = p_.replacements->take(view_.moving, view_.T_eye_model);
  if (!fresh) return;
  p_.contents[fresh->place] = fresh->content;
  fresh->content.painter->setSizeDivisor(scale());
  homes_[fresh->place].drawing_s = 0;
  if (fresh->place != content_) return;
  first_refinement_ = true;  // something of it is seen soon
  showContent(content_);
}

render::DrawTimes WallLoop::draw(std::size_t step, Timestamp until) {
  return painter().draw({view_.T_eye_model, step, until, p_.governor.exponent()});
}

void WallLoop::look(std::int64_t k, Timestamp began) {
  const WallInput input = p_.feed.read(began);
  const Timestamp read = p_.clock.now();
  const bool was_moving = view_.moving;
  nextContent(input.next_content);
  for (std::uint32_t i = 0; i < input.snapshot; ++i) p_.on_snapshot();
  snapshots_ += input.snapshot;
  view_ = p_.scene.update(input.scene, began);
  if (p_.marker) p_.marker->pointAt(pointedAt());
  const std::size_t asked = next_contents_ % p_.contents.size();
  if (asked != content_) showContent(asked);
  if (lost_.update(painter().sees(view_.T_eye_model), view_.moving, began)) {
    ++out_.returned;
    returnHome();  // from the next period on
  }
  std::copy(input.posture.begin(), input.posture.end(), out_.posture);
  if (was_moving && !view_.moving) {
    still_since_ = began;
    first_refinement_ = true;
    fade_.keep(painter().pixels());
  }
  if (!was_moving && view_.moving) resuming_ = true;
  tracer_.begin(began, deadline(k), view_.moving);
  tracer_.add(StepKind::kInput, began, read);
  tracer_.add(StepKind::kScene, read, p_.clock.now());
}

// After a frame that ran over, less than a period is left: fewer triangles, or none before the
// next. With a whole one, a level that is nearly right stays.
std::size_t WallLoop::chooseStep(Duration available) {
  const std::size_t budget = p_.governor.budgetFor(available);
  if (budget == 0) return detail().steps();
  if (budget != p_.governor.budget()) return detail().stepWithin(budget);
  if (moving_step_ && !p_.governor.held()) {
    const auto had = static_cast<double>(detail().costOf(*moving_step_));
    if (std::abs(had / static_cast<double>(budget) - 1) < kSameLevel) return *moving_step_;
  }
  moving_step_ = detail().stepWithin(budget);
  return *moving_step_;
}

std::int64_t WallLoop::movingFrame(std::int64_t k, Timestamp began) {
  const Timestamp looked = p_.clock.now();
  const Duration left = deadline(k) - began;
  std::size_t step = chooseStep(
      resuming_ ? std::min(left, fromSeconds(kResumingShare * toSeconds(period_))) : left);
  if (resuming_ && step == detail().steps()) step = chooseStep(left);
  tracer_.add(StepKind::kGovernor, looked, p_.clock.now());
  if (step == detail().steps()) {
    stats_.deadline(deadline(k), true, false);
    climb(true, true);
    return k + 1;
  }
  step_ = step;
  fade_.stop();
  const render::DrawTimes times = draw(step_, deadline(k) - kPresentMargin);
  tracer_.add(painter().steps());
  const Timestamp drawn = p_.clock.now();
  present(painter().pixels(), step_ == 0, deadline(k));
  const Timestamp finished = p_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, finished);
  refining_ = false;
  const bool met = finished <= deadline(k);
  const std::int64_t next = countDeadlines(k, finished);
  stats_.frame(finished, finished - began, period_, detail().costOf(step_));
  out_.work_ms = static_cast<float>(1000 * toSeconds(finished - began));
  finishMoving(times, finished - drawn, met);
  return next;
}

// A frame that ran over more than its own deadline missed those too.
std::int64_t WallLoop::countDeadlines(std::int64_t k, Timestamp finished) {
  const std::int64_t reached = p_.frame_clock.frameAt(finished);
  stats_.deadline(deadline(k), true, finished <= deadline(k));
  for (std::int64_t missed = k + 1; missed < reached; ++missed)
    stats_.deadline(deadline(missed), true, false);
  return std::max(k + 1, reached);
}

void WallLoop::finishMoving(const render::DrawTimes& times, Duration present, bool met) {
  const std::size_t cost = detail().costOf(step_);
  const bool least = cost <= p_.governor.least() || step_ + 1 == detail().steps();
  // The cost that the frame would have had with every view as fine as the wall.
  const Duration fixed = times.fixed + present;
  if (!resuming_ || !met) p_.governor.observe({cost, fixed, fixed + times.drawing, !met});
  climb(!met, least && !p_.governor.held());
  if (operator_ladder_.observe(times.gave_way, true, true)) ++out_.ladder_steps;
  if (!std::exchange(resuming_, false)) return;
  ++out_.resumed;
  out_.resumed_late += met ? 0 : 1;
}

// Size and rate give way where not even the fewest triangles come in time, and come back where they
// would.
void WallLoop::climb(bool late, bool least) {
  const int was = scale();
  if (!ladder_.observe(late, least, higherFits())) return;
  ++out_.ladder_steps;
  if (scale() < was) p_.governor.expect(was * was);  // at most
  for (const ShownContent& content : p_.contents) content.painter->setSizeDivisor(scale());
}

// At full size a frame costs four times as much at most.
bool WallLoop::higherFits() const {
  const double needed_s = p_.governor.predict(p_.governor.least());
  const double times = ladder_.rung() > 1 ? 2 : 4;
  return times * needed_s < toSeconds(period_) * (1 - p_.governor.headRoom());
}

std::int64_t WallLoop::stillPeriod(std::int64_t k) {
  if (fade_.isOn())
    fadeOn();
  else if (p_.delivery.overlaysHaveChanged())
    present(painter().pixels(), full_detail_);
  if (!full_detail_ && !(step_ == 0 && fade_.isOn())) {
    if (!refining_) beginRefining();
    const Timestamp from = p_.clock.now();
    const bool whole = painter().refine(deadline(k) - kRefineMargin);
    const auto steps = painter().steps();
    if (steps.empty()) tracer_.add(StepKind::kRefine, from, p_.clock.now());
    tracer_.add(steps);
    if (whole) showRefined();
  }
  // The picture that stands is right: the deadline is met, unless refining ran over it.
  const std::int64_t reached = p_.frame_clock.frameAt(p_.clock.now());
  for (std::int64_t passed = k; passed < std::max(k + 1, reached); ++passed)
    stats_.deadline(deadline(passed), false, true);
  return std::max(k + 1, reached);
}

// Something finer soon, where full detail would take long; then eight times as many triangles, and
// so on: all that together takes less than half as long again as full detail alone.
void WallLoop::beginRefining() {
  refining_ = true;
  const std::size_t now = detail().costOf(step_);
  // The model is of frames at scale(); what is refined is at full size.
  const Duration first =
      std::min<Duration>(period_ * 5 / 4, kFirstRefinement) / (scale() * scale());
  const std::size_t finer =
      first_refinement_ ? p_.governor.trianglesWithin(first) : kNextRefinement * now;
  refined_step_ = detail().stepWithin(finer);
  const bool worth = finer > now && finer < detail().fullCost() / 2;
  if (!worth) refined_step_ = 0;
  painter().beginRefining(view_.T_eye_model, refined_step_);
}

void WallLoop::showRefined() {
  refining_ = false;
  step_ = refined_step_;
  fade_.begin(p_.fade_frames);
  fadeOn();
}

// Towards what is refined; full detail is shown when the last frame of it is.
void WallLoop::fadeOn() {
  const Timestamp drawn = p_.clock.now();
  const auto pixels = fade_.next(painter().pixels());
  const bool whole = step_ == 0 && !fade_.isOn();
  present(pixels, whole);
  const Timestamp now = p_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, now);
  const auto since = static_cast<float>(toSeconds(now - still_since_));
  if (std::exchange(first_refinement_, false)) out_.still_to_first_s = since;
  if (whole) out_.still_to_full_s = since;
}

void WallLoop::present(std::span<std::uint8_t> canvas, bool full_detail,
                       std::optional<Timestamp> deadline) {
  full_detail_ = full_detail;
  const auto cost = static_cast<std::uint32_t>(detail().costOf(step_));
  p_.delivery.show(canvas, {++frames_, p_.clock.now(), cost, full_detail}, deadline);
}

}  // namespace merlin::wall
