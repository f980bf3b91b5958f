#include "daemon/wall/wall_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::wall {
namespace {

using shm::StepKind;

// Time left unused at the end of a period that is spent on refining.
constexpr Duration kRefineMargin = std::chrono::milliseconds(2);
// Time reserved to read back the last tile and pass the frame to the outputs.
constexpr Duration kPresentMargin = std::chrono::milliseconds(3);
// Share of a period that is planned for the first frame after a standstill, which takes longer than
// predicted: cores wake from sleep, and caches hold data of another frame.
constexpr double kResumingShare = 0.75;
// The detail step is kept while its cost differs from the budget by less than this share, so that
// detail does not flicker during motion.
constexpr double kSameCost = 0.04;

}  // namespace

WallLoop::WallLoop(WallParts parts)
    : p_(std::move(parts)),
      turns_(p_.contents, p_.governor),
      pace_(p_.governor),
      still_(p_.governor, p_.fade_frames),
      publisher_(p_.slots),
      view_(p_.scene.view()),
      lost_(p_.return_after_s) {
  p_.scene.setNavigation(turns_.navigation());
  turns_.requestNext(static_cast<std::uint32_t>(p_.first_content));
}

void WallLoop::calibrate() { turns_.calibrate(view_.T_eye_model); }

void WallLoop::run(const std::stop_token& stop, const std::function<void()>& first_frame) {
  p_.frame_clock.start(p_.clock.now(), pace_.period());
  bool first = true;
  for (std::int64_t k = 0; p_.frame_clock.waitFor(k, stop);) {
    const Timestamp began = p_.clock.now();
    applyRequests();
    if (pace_.update()) {
      p_.frame_clock.start(p_.frame_clock.begin(k), pace_.period());
      k = 0;
    }
    readInput(k, began);
    k = view_.moving ? movingFrame(k, began) : stillPeriod(k);
    publish();
    if (p_.progress) p_.progress->step();
    if (std::exchange(first, false)) first_frame();
    replaceContents();
  }
}

void WallLoop::applyRequests() {
  const std::uint32_t requests = requests_.exchange(0);
  if (requests & kResetView) returnToInitialView();
  if (requests & kNextMode) p_.scene.nextMode();
  if (requests & kNextContent) {
    turns_.requestNext(1);
    p_.scene.reset();
  }
}

void WallLoop::move(const render::scene::Push& step) {
  const std::lock_guard lock(step_mutex_);
  step_asked_.way_m += step.way_m;
  step_asked_.turn_rad += step.turn_rad;
}

render::scene::Push WallLoop::takeStep() {
  const std::lock_guard lock(step_mutex_);
  return std::exchange(step_asked_, {});
}

void WallLoop::returnToInitialView() {
  p_.scene.reset();
  turns_.expectInitialView();
}

void WallLoop::showContent() {
  step_ = detail().steps() - 1;
  moving_step_.reset();
  full_detail_ = false;
  still_.stop();
}

void WallLoop::replaceContents() {
  if (!p_.replacements) return;
  const auto fresh = p_.replacements->take(view_.moving, view_.T_eye_model);
  if (!fresh || !turns_.replace(*fresh)) return;
  showContent();
  still_.restart();
}

void WallLoop::readInput(std::int64_t k, Timestamp began) {
  WallInput input = p_.feed.read(began);
  input.scene.step = takeStep();
  const Timestamp read = p_.clock.now();
  const bool was_moving = view_.moving;
  // The next content is shown after the scene's update, from its initial view.
  turns_.requestNext(input.next_content);
  if (input.next_content > 0) p_.scene.reset();
  for (std::uint32_t i = 0; i < input.snapshot; ++i) p_.on_snapshot();
  snapshots_ += input.snapshot;
  if (!input.align.isNothing()) p_.on_align(input.align);
  view_ = p_.scene.update(input.scene, began);
  if (p_.marker) p_.marker->pointAt(pointedAt());
  if (turns_.showRequested()) {
    p_.scene.setNavigation(turns_.navigation());
    view_ = p_.scene.view();
    showContent();
  }
  // Updated between frames, so that all tiles of a frame have the same viewer position.
  if (p_.viewer && p_.viewer->update(input.head, began)) view_.moving = true;
  if (lost_.update(painter().sees(view_.T_eye_model), view_.moving, began)) {
    ++counted_.returned;
    returnToInitialView();  // takes effect in the next period
  }
  std::copy(input.posture.begin(), input.posture.end(), counted_.posture);
  if (was_moving && !view_.moving) still_.begin(began, painter().pixels());
  if (!was_moving && view_.moving) resuming_ = true;
  tracer_.begin(began, deadline(k), view_.moving);
  tracer_.add(StepKind::kInput, began, read);
  tracer_.add(StepKind::kScene, read, p_.clock.now());
}

std::optional<Eigen::Vector3f> WallLoop::pointedAt() const {
  if (!view_.pointed) return std::nullopt;
  return view_.pointed->at_eye_m;
}

std::size_t WallLoop::chooseStep(std::int64_t k, Timestamp began) {
  const Duration left = deadline(k) - began;
  if (!resuming_) return stepFor(left);
  const Duration share = fromSeconds(kResumingShare * toSeconds(pace_.period()));
  const std::size_t step = stepFor(std::min(left, share));
  return step == detail().steps() ? stepFor(left) : step;
}

// After a frame that ran over, less than a period is left, so there is time for less detail, or for
// no frame. With a whole period, the last step is kept if it is nearly right.
std::size_t WallLoop::stepFor(Duration available) {
  const std::size_t budget = p_.governor.budgetFor(available);
  if (budget == 0) return detail().steps();
  if (budget != p_.governor.budget()) return detail().stepWithin(budget);
  if (moving_step_ && !p_.governor.held()) {
    const auto had = static_cast<double>(detail().costOf(*moving_step_));
    if (std::abs(had / static_cast<double>(budget) - 1) < kSameCost) return *moving_step_;
  }
  moving_step_ = detail().stepWithin(budget);
  return *moving_step_;
}

std::int64_t WallLoop::movingFrame(std::int64_t k, Timestamp began) {
  const Timestamp choosing = p_.clock.now();
  const std::size_t step = chooseStep(k, began);
  tracer_.add(StepKind::kGovernor, choosing, p_.clock.now());
  if (step == detail().steps()) {
    stats_.deadline(deadline(k), true, false);
    if (pace_.observe(true, true)) turns_.setSizeDivisor(pace_.sizeDivisor());
    return k + 1;
  }
  step_ = step;
  still_.stop();
  const render::frame::DrawTimes times = painter().draw(
      {view_.T_eye_model, step_, deadline(k) - kPresentMargin, p_.governor.exponent()});
  tracer_.add(painter().steps());
  const Timestamp drawn = p_.clock.now();
  present(painter().pixels(), step_ == 0, deadline(k));
  const Timestamp finished = p_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, finished);
  const bool met = finished <= deadline(k);
  const std::int64_t next = countDeadlines(k, finished);
  stats_.frame(finished, finished - began, pace_.period(), detail().costOf(step_));
  counted_.work_ms = static_cast<float>(1000 * toSeconds(finished - began));
  finishMoving(times, finished - drawn, met);
  return next;
}

// Counts all deadlines that a frame has passed: its own, and later ones if it ran over them too.
// Returns the number of the next frame.
std::int64_t WallLoop::countDeadlines(std::int64_t k, Timestamp finished) {
  const std::int64_t reached = p_.frame_clock.frameAt(finished);
  stats_.deadline(deadline(k), true, finished <= deadline(k));
  for (std::int64_t missed = k + 1; missed < reached; ++missed)
    stats_.deadline(deadline(missed), true, false);
  return std::max(k + 1, reached);
}

void WallLoop::finishMoving(const render::frame::DrawTimes& times, Duration present, bool met) {
  const std::size_t cost = detail().costOf(step_);
  const bool coarsest = cost <= p_.governor.least() || step_ + 1 == detail().steps();
  // times.drawing is that of a frame whose operator's view is as fine as the wall: see DrawTimes.
  const Duration fixed = times.fixed + present;
  if (!resuming_ || !met) p_.governor.observe({cost, fixed, fixed + times.drawing, !met});
  if (pace_.observe(!met, coarsest && !p_.governor.held()))
    turns_.setSizeDivisor(pace_.sizeDivisor());
  pace_.observeOperator(times.gave_way);
  if (!std::exchange(resuming_, false)) return;
  ++counted_.resumed;
  counted_.resumed_late += met ? 0 : 1;
}

std::int64_t WallLoop::stillPeriod(std::int64_t k) {
  if (still_.isFading())
    showFading();
  else if (p_.delivery.hasChanged(p_.clock.now()))
    present(painter().pixels(), full_detail_);
  if (!full_detail_ && !(step_ == 0 && still_.isFading())) refine(k);
  // The frame shown is still valid, so every deadline that has passed counts as met.
  const std::int64_t reached = p_.frame_clock.frameAt(p_.clock.now());
  for (std::int64_t passed = k; passed < std::max(k + 1, reached); ++passed)
    stats_.deadline(deadline(passed), false, true);
  return std::max(k + 1, reached);
}

void WallLoop::refine(std::int64_t k) {
  const Timestamp from = p_.clock.now();
  const auto finer = still_.refine(turns_, view_.T_eye_model, step_, pace_.sizeDivisor(),
                                   deadline(k) - kRefineMargin);
  const auto steps = painter().steps();
  if (steps.empty()) tracer_.add(StepKind::kRefine, from, p_.clock.now());
  tracer_.add(steps);
  if (!finer) return;
  step_ = *finer;
  showFading();
}

// Full detail counts as shown when the last frame of the fade to it is shown.
void WallLoop::showFading() {
  const Timestamp drawn = p_.clock.now();
  const auto pixels = still_.nextFading(painter().pixels());
  const bool full_detail = step_ == 0 && !still_.isFading();
  present(pixels, full_detail);
  const Timestamp now = p_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, now);
  const StillFrame::Times times = still_.shown(now, full_detail);
  if (times.to_first_s) counted_.still_to_first_s = *times.to_first_s;
  if (times.to_full_s) counted_.still_to_full_s = *times.to_full_s;
}

void WallLoop::present(std::span<std::uint8_t> canvas, bool full_detail,
                       std::optional<Timestamp> deadline) {
  full_detail_ = full_detail;
  const auto cost = static_cast<std::uint32_t>(detail().costOf(step_));
  p_.delivery.show(canvas, {++frames_, p_.clock.now(), cost, full_detail}, deadline);
}

void WallLoop::publish() {
  const Timestamp now = p_.clock.now();
  tracer_.end(now, static_cast<std::uint32_t>(detail().costOf(step_)));
  publisher_.trace(tracer_);
  stats_.advance(now);
  counted_.frames = frames_;
  counted_.full_detail = full_detail_;
  counted_.input_age_ms = static_cast<float>(1000 * toSeconds(p_.feed.age()));
  publisher_.stats(counted_, {turns_, pace_, p_.governor, stats_, view_, step_}, now);
  publisher_.interaction(view_, p_.marker, snapshots_, turns_.index(), now);
  publisher_.outputs(p_.delivery.outputs(), now);
}

}  // namespace merlin::wall
