#include "daemon/wall/wall_loop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace merlin::wall {
namespace {

using shm::StepKind;

// Time that refining leaves unused at the end of a period.
constexpr Duration kRefineMargin = std::chrono::milliseconds(2);
// Time that is reserved for reading back the last tile and passing the frame to the outputs.
constexpr Duration kPresentMargin = std::chrono::milliseconds(3);
// Share of a period that is planned for the first frame after a standstill, which takes longer than
// predicted: cores wake from sleep, and caches hold data of another frame.
constexpr double kResumingShare = 0.75;
// Shares of a period that are planned for the first frames of another content, whose data is not in
// any cache yet.
constexpr std::array kNewContentShares{0.4, 0.55, 0.75};
// The detail step is kept while its cost differs from the budget by less than this share, so that
// detail does not flicker during motion.
constexpr double kSameCost = 0.04;

}  // namespace

WallLoop::WallLoop(WallParts parts)
    : parts_(std::move(parts)),
      turns_(parts_.contents, parts_.governor, parts_.replacements, parts_.listed),
      pace_(parts_.governor),
      still_(parts_.governor, parts_.fade_frames),
      publisher_(parts_.slots),
      view_(parts_.scene.view()),
      lost_(parts_.return_after_s) {
  useNavigation();
  pace_.show(detail());
  turns_.request(parts_.first_content);
}

void WallLoop::calibrate() { turns_.calibrate(view_.T_eye_model); }

void WallLoop::run(const std::stop_token& stop, const std::function<void()>& first_frame) {
  parts_.frame_clock.start(parts_.clock.now(), pace_.period());
  parts_.feed.lookAhead(pace_.period());
  bool first = true;
  for (std::int64_t k = 0; parts_.frame_clock.waitFor(k, stop);) {
    const Timestamp began = parts_.clock.now();
    applyRequests();
    if (pace_.update()) {
      parts_.frame_clock.start(parts_.frame_clock.begin(k), pace_.period());
      parts_.feed.lookAhead(pace_.period());  // a frame becomes visible when the next one begins
      k = 0;
    }
    readInput(k, began);
    k = view_.moving ? movingFrame(k, began) : stillPeriod(k);
    publish();
    if (parts_.progress) parts_.progress->step();
    if (std::exchange(first, false)) first_frame();
    replaceContents();
  }
}

void WallLoop::applyRequests() {
  applyTuning();
  const std::uint32_t requests = requests_.exchange(0);
  if (requests & kResetView) returnToInitialView();
  if (requests & kNextMode) parts_.scene.nextMode();
  if (requests & kNextContent) turns_.requestNext(1);
  if (requests & kPreviousContent) turns_.requestPrevious(1);
  if (requests & (kNextContent | kPreviousContent)) parts_.scene.reset();
  const std::int64_t place = place_asked_.exchange(-1);
  if (place >= 0) {
    turns_.choose(static_cast<std::size_t>(place));
    parts_.scene.reset();
  }
  if (requests != 0 || place >= 0) parts_.attendance.touch();
}

void WallLoop::tune(WallTuning tuning) {
  const std::lock_guard lock(step_mutex_);
  tunings_.push_back(std::move(tuning));
}

void WallLoop::applyTuning() {
  std::vector<WallTuning> tunings;
  {
    const std::lock_guard lock(step_mutex_);
    tunings.swap(tunings_);
  }
  for (WallTuning& tuning : tunings) {
    if (tuning.governor) {
      parts_.governor.setLimits(*tuning.governor);
      pace_.configure(tuning.governor->rate_hz);
      if (parts_.panel) parts_.panel->configure(tuning.governor->rate_hz);
    }
    if (tuning.playlist) {
      parts_.attendance.configure(*tuning.playlist);
      parts_.playlist = std::move(tuning.places);
    }
    if (tuning.scene) {
      (void)parts_.scene.configure(*tuning.scene);  // validated by the loader
      lost_.setReturnAfter(tuning.scene->return_after_s);
    }
    if (tuning.feed) parts_.feed.configure(*tuning.feed);
  }
}

void WallLoop::useNavigation() {
  parts_.scene.setNavigation(turns_.navigation(), turns_.nearest());
}

void WallLoop::finishRequest(std::uint32_t number, const std::string& refused) {
  const std::lock_guard lock(step_mutex_);
  results_.add({number, refused});
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
  parts_.scene.reset();
  turns_.expectInitialView();
}

void WallLoop::showContent() {
  new_frames_ = kNewContentShares.size();
  pace_.show(detail());
  step_ = detail().steps() - 1;
  moving_step_.reset();
  full_detail_ = false;
  still_.stop();
  publishContent(parts_.clock.now());  // overlays on its first frame read the content's name there
}

void WallLoop::replaceContents() {
  if (!parts_.replacements || parts_.attendance.isFrozen()) return;
  const auto fresh = parts_.replacements->take(view_.moving, view_.T_eye_model);
  if (!fresh) return;
  if (!fresh->refused.empty()) return noteRefusal(*fresh);
  const bool shown = turns_.replace(*fresh);
  if (fresh->request > 0) showChosen(*fresh);
  if (fresh->asked_for) {
    turns_.request(fresh->place);
    parts_.scene.reset();
  }
  if (!shown) return;
  useNavigation();
  showContent();
  still_.restart();
}

// Shows a content that a person requested. If reading it took long, the playlist may run again by
// now. It is then ended, so that the content is shown as long as one that could be read at once.
void WallLoop::showChosen(const ContentSource::Replacement& chosen) {
  turns_.choose(chosen.place);
  parts_.attendance.attend();
  finishRequest(chosen.request, {});
}

// Handles a request that was refused. If the folder of slides that is shown has vanished or become
// empty, another content is requested, so that people and the playlist can get to the other
// contents.
void WallLoop::noteRefusal(const ContentSource::Replacement& refused) {
  const bool playing = parts_.attendance.playlist() == Playlist::State::kRunning;
  const std::vector<std::size_t> places = playing ? parts_.playlist : std::vector<std::size_t>();
  if (refused.goes_on && turns_.leave(refused.place, places)) parts_.scene.reset();
  if (refused.request > 0) finishRequest(refused.request, refused.refused);
}

// Reads the devices' input, and returns the part of it that takes effect: the operator's panel may
// use some of it, and the rest does not move the scene while the wall is black or frozen.
WallInput WallLoop::attendedInput(Timestamp now) {
  WallInput input = parts_.feed.read(now);
  input.scene.step = takeStep();
  if (parts_.panel) {
    parts_.panel->update(input, now);
    parts_.feed.leaveOutBall(parts_.panel->takesBall());
  }
  const Attendance::Frame frame = parts_.attendance.update(input, now);
  held_ = frame.held;
  if (parts_.curtain) parts_.curtain->setLight(frame.playlist.light);
  followPlaylist(frame.playlist);
  return input;
}

// Executes what the playlist wants. Each content of the playlist begins with its initial view,
// wherever a visitor left it. If a person has chosen the content shown when the playlist begins,
// the playlist shows it first, as long as each of its own contents.
void WallLoop::followPlaylist(const Playlist::Wanted& wanted) {
  const std::size_t before = turns_.asked();
  if (wanted.next || (wanted.begins && !turns_.belongsTo(parts_.playlist)))
    turns_.requestNextOf(parts_.playlist);
  if (turns_.asked() != before)
    parts_.scene.reset();
  else if (wanted.begins)
    returnToInitialView();
}

// Updates the marker, the viewer's position and the return to the initial view; but not while the
// wall is black or frozen, since the picture must not change then.
void WallLoop::followViewer(const WallInput& input, Timestamp now) {
  if (held_) return;
  if (parts_.marker) parts_.marker->pointAt(pointedAt());
  // The viewer is updated between frames, so that all tiles of a frame are drawn for the same
  // position.
  if (parts_.viewer && parts_.viewer->update(input.head, now)) view_.moving = true;
  if (!lost_.update(painter().sees(view_.T_eye_model), view_.moving, now)) return;
  ++counted_.returned;
  returnToInitialView();  // takes effect in the next period
}

void WallLoop::readInput(std::int64_t k, Timestamp began) {
  const WallInput input = attendedInput(began);
  const Timestamp read = parts_.clock.now();
  const bool was_moving = view_.moving;
  // The requested content is shown after the update of the scene, from its initial view.
  turns_.requestNext(input.next_content);
  turns_.requestPrevious(input.previous_content);
  if (input.next_content + input.previous_content > 0) parts_.scene.reset();
  for (std::uint32_t i = 0; i < input.snapshot; ++i) parts_.on_snapshot();
  if (!input.align.isNothing()) parts_.on_align(input.align);
  view_ = parts_.scene.update(input.scene, began);
  if (turns_.showRequested()) {
    useNavigation();
    view_ = parts_.scene.view();
    showContent();
  }
  followViewer(input, began);
  std::copy(input.posture.begin(), input.posture.end(), counted_.posture);
  if (was_moving && !view_.moving) still_.begin(began, painter().pixels());
  if (!was_moving && view_.moving) resuming_ = true;
  tracer_.begin(began, deadline(k), view_.moving);
  tracer_.add(StepKind::kInput, began, read);
  tracer_.add(StepKind::kScene, read, parts_.clock.now());
}

render::frame::PointerMarker::Points WallLoop::pointedAt() const {
  render::frame::PointerMarker::Points points;
  if (view_.pointed) points[0] = view_.pointed->at_eye_m;
  for (std::size_t i = 0; i < view_.others_pointed.size() && i + 1 < points.size(); ++i)
    points[i + 1] = view_.others_pointed[i].at_eye_m;
  return points;
}

// A new content and the resumption of motion reduce the share that is planned.
double WallLoop::plannedShare() const {
  if (new_frames_ > 0) return kNewContentShares[kNewContentShares.size() - new_frames_];
  return resuming_ ? kResumingShare : 1;
}

std::size_t WallLoop::chooseStep(std::int64_t k, Timestamp began) {
  const Duration left = deadline(k) - began;
  const double share = plannedShare();
  if (share == 1) return stepFor(left);
  const std::size_t step = stepFor(std::min(left, fromSeconds(share * toSeconds(pace_.period()))));
  return step == detail().steps() ? stepFor(left) : step;
}

// `available`: time until the deadline. If the previous frame was late, this is less than a period,
// so there is time for less detail only, or for no frame. With a whole period, the step of the last
// moving frame is kept if its cost is close to the budget.
std::size_t WallLoop::stepFor(Duration available) {
  const std::size_t budget = parts_.governor.budgetFor(available);
  if (budget == 0) return detail().steps();
  if (budget != parts_.governor.budget()) return detail().stepWithin(budget);
  if (moving_step_ && !parts_.governor.held()) {
    const auto had = static_cast<double>(detail().costOf(*moving_step_));
    if (std::abs(had / static_cast<double>(budget) - 1) < kSameCost) return *moving_step_;
  }
  moving_step_ = detail().stepWithin(budget);
  return *moving_step_;
}

std::int64_t WallLoop::movingFrame(std::int64_t k, Timestamp began) {
  const Timestamp choosing = parts_.clock.now();
  const std::size_t step = chooseStep(k, began);
  tracer_.add(StepKind::kGovernor, choosing, parts_.clock.now());
  if (step == detail().steps()) {
    stats_.deadline(deadline(k), true, false);
    tracer_.leaveOut();
    if (pace_.observe(true, true)) turns_.setSizeDivisor(pace_.sizeDivisor());
    return k + 1;
  }
  step_ = step;
  still_.stop();
  const render::frame::DrawTimes times = painter().draw(
      {view_.T_eye_model, step_, deadline(k) - kPresentMargin, parts_.governor.exponent()});
  tracer_.add(painter().steps());
  const Timestamp drawn = parts_.clock.now();
  const bool whole = step_ == 0 && painter().pending() == render::content::Pending::kNothing;
  present(painter().pixels(), whole, deadline(k));
  const Timestamp finished = parts_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, finished);
  const bool met = finished <= deadline(k);
  const std::int64_t next = countDeadlines(k, finished);
  stats_.frame(finished, finished - began, pace_.period(), detail().costOf(step_));
  counted_.work_ms = static_cast<float>(1000 * toSeconds(finished - began));
  finishMoving(times, finished - drawn, met);
  return next;
}

// Counts the deadlines that have passed when frame k is finished: its own one, and later ones if it
// took longer than a period. Returns the number of the next frame.
std::int64_t WallLoop::countDeadlines(std::int64_t k, Timestamp finished) {
  const std::int64_t reached = parts_.frame_clock.frameAt(finished);
  stats_.deadline(deadline(k), true, finished <= deadline(k));
  for (std::int64_t missed = k + 1; missed < reached; ++missed) {
    stats_.deadline(deadline(missed), true, false);
    tracer_.runOver(deadline(missed - 1), deadline(missed));
  }
  return std::max(k + 1, reached);
}

void WallLoop::finishMoving(const render::frame::DrawTimes& times, Duration present, bool met) {
  const std::size_t cost = detail().costOf(step_);
  const bool coarsest = cost <= parts_.governor.least() || step_ + 1 == detail().steps();
  // times.drawing is the time that the frame would take if the operator's view were as fine as the
  // wall (see DrawTimes).
  const Duration fixed = times.fixed + present;
  const bool usual = plannedShare() == 1;
  if (usual || !met) parts_.governor.observe({cost, fixed, fixed + times.drawing, !met});
  if (new_frames_ > 0) --new_frames_;
  if (pace_.observe(!met, coarsest && !parts_.governor.held()))
    turns_.setSizeDivisor(pace_.sizeDivisor());
  pace_.observeOperator(times.gave_way);
  if (!std::exchange(resuming_, false)) return;
  ++counted_.resumed;
  counted_.resumed_late += met ? 0 : 1;
}

std::int64_t WallLoop::stillPeriod(std::int64_t k) {
  if (still_.isFading())
    showFading();
  else if (parts_.delivery.hasChanged(parts_.clock.now()))
    present(painter().pixels(), full_detail_);
  // If a missing part of the content has been loaded meanwhile, the frame is refined once more.
  if (painter().pending() == render::content::Pending::kArrived) full_detail_ = false;
  if (needsRefining()) refine(k);
  // The frame shown is still valid, so all deadlines that have passed count as met.
  const std::int64_t reached = parts_.frame_clock.frameAt(parts_.clock.now());
  for (std::int64_t passed = k; passed < std::max(k + 1, reached); ++passed)
    stats_.deadline(deadline(passed), false, true);
  return std::max(k + 1, reached);
}

// Returns false at full detail and during the fade to the finest step; also if all missing parts of
// the content are still being loaded, since there is nothing to draw until one of them is loaded.
bool WallLoop::needsRefining() const {
  if (full_detail_ || (step_ == 0 && still_.isFading())) return false;
  const bool waits = step_ == 0 && !still_.isRefining() &&
                     painter().pending() == render::content::Pending::kLoading;
  return !waits;
}

void WallLoop::refine(std::int64_t k) {
  const Timestamp from = parts_.clock.now();
  const auto finer = still_.refine(turns_, view_.T_eye_model, step_, pace_.sizeDivisor(),
                                   deadline(k) - kRefineMargin);
  const auto steps = painter().steps();
  if (steps.empty()) tracer_.add(StepKind::kRefine, from, parts_.clock.now());
  tracer_.add(steps);
  if (!finer) return;
  step_ = *finer;
  showFading();
}

// Shows the next frame of the fade. Full detail counts as shown when the last frame of the fade to
// it is shown.
void WallLoop::showFading() {
  const Timestamp drawn = parts_.clock.now();
  const auto pixels = still_.nextFading(painter().pixels());
  const bool full_detail =
      step_ == 0 && !still_.isFading() && painter().pending() == render::content::Pending::kNothing;
  present(pixels, full_detail);
  const Timestamp now = parts_.clock.now();
  tracer_.add(StepKind::kPresent, drawn, now);
  const StillFrame::Times times = still_.shown(now, full_detail);
  if (times.to_first_s) counted_.still_to_first_s = *times.to_first_s;
  if (times.to_full_s) counted_.still_to_full_s = *times.to_full_s;
}

void WallLoop::present(std::span<std::uint8_t> canvas, bool full_detail,
                       std::optional<Timestamp> deadline) {
  full_detail_ = full_detail;
  const auto cost = static_cast<std::uint32_t>(detail().costOf(step_));
  parts_.delivery.show(canvas, {++frames_, parts_.clock.now(), cost, full_detail}, deadline);
}

void WallLoop::publish() {
  const Timestamp now = parts_.clock.now();
  tracer_.end(now, static_cast<std::uint32_t>(detail().costOf(step_)));
  publisher_.trace(tracer_);
  stats_.advance(now);
  counted_.frames = frames_;
  counted_.full_detail = full_detail_;
  counted_.input_age_ms = static_cast<float>(1000 * toSeconds(parts_.feed.age()));
  publisher_.stats(counted_, {turns_, pace_, parts_.governor, stats_, view_, step_}, now);
  const Attendance& attendance = parts_.attendance;
  shm::WallInteraction interaction{};
  interaction.snapshots = parts_.snapshots_written();
  interaction.content = static_cast<std::uint32_t>(turns_.index()) + parts_.first_number;
  interaction.shown = attendance.shown();
  interaction.playlist = static_cast<std::uint32_t>(attendance.playlist());
  interaction.light = attendance.light();
  publisher_.interaction(interaction, view_, parts_.marker, now);
  publisher_.idle(attendance.due(), parts_.shows_testcard(), now);
  publishContent(now);
  publisher_.outputs(parts_.delivery.outputs(), now);
}

void WallLoop::publishContent(Timestamp now) {
  const std::lock_guard lock(step_mutex_);
  publisher_.content(turns_.content(), results_.current(now), now);
}

}  // namespace merlin::wall
