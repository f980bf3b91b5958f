#include "render/panel/panel_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace merlin::render::panel {
namespace {

constexpr std::size_t kMostActs = 16;

std::optional<ControlId> idOf(const Button* button) {
  return button ? std::optional(button->id) : std::nullopt;
}

}  // namespace

void PanelInput::begin(std::optional<Press>& press, ControlId id, Timestamp now) {
  press = Press{id, now, now + kRepeatAfter};
  if (actsOf(id) == Acts::kStep && acts_.size() < kMostActs) acts_.push_back(id);
}

void PanelInput::repeat(std::optional<Press>& press, Timestamp now) {
  if (!press || actsOf(press->id) != Acts::kStep || now < press->next_act) return;
  press->next_act = now + kRepeatEvery;
  if (acts_.size() < kMostActs) acts_.push_back(press->id);
}

void PanelInput::point(Point in_tile, bool pressed, Timestamp now) {
  hovered_ = idOf(buttonAt(layout_, in_tile));
  const bool was_down = std::exchange(down_, pressed);
  if (pressed && !was_down && hovered_) begin(press_, *hovered_, now);
  if (press_) press_->heard = now;
  if (pressed || !press_) return;
  const bool clicked = hovered_ == press_->id && actsOf(press_->id) == Acts::kClick;
  if (clicked && acts_.size() < kMostActs) acts_.push_back(press_->id);
  press_.reset();
}

void PanelInput::leave() {
  hovered_.reset();
  press_.reset();
  down_ = false;
}

void PanelInput::enterByBall(Timestamp now) {
  by_ball_ = true;
  selected_ = kFirst;
  armed_ = false;
  used_ = now;
  ball_press_.reset();
  next_step_ = Timestamp::max();
}

void PanelInput::leaveByBall() {
  by_ball_ = false;
  ball_press_.reset();
}

void PanelInput::select(int right, int down, Timestamp now) {
  if (next_step_ && now < *next_step_) return;
  selected_ = neighbourOf(layout_, selected_, right, down);
  next_step_ = now + (next_step_ ? kRepeatEvery : kRepeatAfter);
}

void PanelInput::ball(const BallPush& push, Timestamp now) {
  if (!by_ball_) return;
  const float most = std::max(std::abs(push.right), std::abs(push.up));
  const bool across = std::abs(push.right) >= std::abs(push.up);
  if (most > kPush && !ball_press_)
    select(across ? (push.right > 0 ? 1 : -1) : 0, across ? 0 : (push.up > 0 ? -1 : 1), now);
  if (most < kPush / 2) next_step_.reset();
  if (most > kPush || push.button) used_ = now;
  if (!push.button) {
    armed_ = true;
    ball_press_.reset();
  } else if (std::exchange(armed_, false)) {
    begin(ball_press_, selected_, now);
    if (actsOf(selected_) == Acts::kClick && acts_.size() < kMostActs) acts_.push_back(selected_);
  }
}

void PanelInput::update(Timestamp now) {
  if (press_ && now - press_->heard >= kForgotten) leave();
  if (press_ && hovered_ == press_->id) repeat(press_, now);
  repeat(ball_press_, now);
  if (by_ball_ && now - used_ >= kIdle) leaveByBall();
}

std::vector<ControlId> PanelInput::takeActs() { return std::exchange(acts_, {}); }

std::optional<ControlId> PanelInput::selected() const noexcept {
  return by_ball_ ? std::optional(selected_) : std::nullopt;
}

std::optional<ControlId> PanelInput::pressed() const noexcept {
  if (press_ && hovered_ == press_->id) return press_->id;
  return ball_press_ ? std::optional(ball_press_->id) : std::nullopt;
}

}  // namespace merlin::render::panel
