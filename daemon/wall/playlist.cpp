#include "daemon/wall/playlist.h"

#include <algorithm>
#include <utility>

#include "daemon/base/radian.h"

namespace merlin::wall {

Playlist::State Playlist::state() const noexcept {
  if (running_) return State::kRunning;
  return enabled_ && settings_.after_s > 0 ? State::kWaiting : State::kOff;
}

Playlist::Due Playlist::due() const noexcept {
  Due due;
  const double idle_s = toSeconds(idle_);
  if (state() == State::kWaiting) due.begins_s = std::max(0.0, settings_.after_s - idle_s);
  if (running_) due.next_s = std::max(0.0, settings_.hold_s - toSeconds(shown_));
  if (enabled_ && settings_.dim_after_s > idle_s) due.dims_s = settings_.dim_after_s - idle_s;
  return due;
}

void Playlist::on() noexcept {
  enabled_ = true;
  starting_ = !running_;
  idle_ = Duration::zero();
}

void Playlist::off() noexcept { enabled_ = starting_ = running_ = false; }

void Playlist::next() noexcept {
  next_ = true;
  if (!running_) idle_ = Duration::zero();
}

Playlist::Wanted Playlist::update(Duration elapsed, bool touched) noexcept {
  idle_ = touched ? Duration::zero() : idle_ + elapsed;
  if (touched) running_ = false;
  const bool due = state() == State::kWaiting && idle_ >= fromSeconds(settings_.after_s);
  Wanted wanted;
  wanted.next = std::exchange(next_, false);
  wanted.begins = std::exchange(starting_, false) || due;
  if (wanted.begins) running_ = true;
  shown_ = wanted.begins || wanted.next ? Duration::zero() : shown_ + elapsed;
  if (running_) {
    if (shown_ >= fromSeconds(settings_.hold_s)) {
      wanted.next = true;
      shown_ = Duration::zero();
    }
    wanted.turn_rad_s = static_cast<float>(settings_.turn_deg_per_s * kRadian<double>);
  }
  wanted.light = light();
  return wanted;
}

float Playlist::light() const noexcept {
  if (!enabled_ || settings_.dim_after_s <= 0) return 1;
  const double since_s = toSeconds(idle_) - settings_.dim_after_s;
  const double part = std::clamp(since_s / toSeconds(kDimming), 0.0, 1.0);
  return static_cast<float>(1 - part * (1 - settings_.dim_to));
}

}  // namespace merlin::wall
