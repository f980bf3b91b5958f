// PanelInput: turns motions of the pointer and the ball on the operator's panel into acts of its
// controls, and records which control is hovered, selected and pressed. Pure.
#pragma once

#include <optional>
#include <vector>

#include "daemon/base/clock.h"
#include "render/panel/panel_layout.h"

namespace merlin::render::panel {

// State of the ball: a push to the right and up, as shares of full scale, and whether one of its
// buttons is held.
struct BallPush {
  float right = 0, up = 0;
  bool button = false;
};

// Thread-bound.
class PanelInput {
 public:
  // `layout` must outlive this object.
  explicit PanelInput(const PanelLayout& layout) : layout_(layout) {}

  // Reports the pointer's position in the tile [px] and whether its button is pressed. A press
  // counts only if it begins on a control. If the pointer is dragged away and released elsewhere,
  // the control is not clicked.
  void point(Point in_tile, bool pressed, Timestamp now);
  // Reports that the pointer has left the tile or no longer exists.
  void leave();

  // Called when the ball begins, or ceases, to operate the panel. The selection begins at kFirst,
  // wherever it was the last time. A button or a push that is held at that moment has no effect
  // until it is released.
  void enterByBall(Timestamp now);
  void leaveByBall();
  // Reports the ball's state. To be called once a frame while the ball operates the panel;
  // otherwise it has no effect.
  void ball(const BallPush& push, Timestamp now);

  // To be called once a frame: what is held acts again. A pointer's press that was not reported for
  // kForgotten counts as released; a ball that was not used for kIdle ceases to operate the panel.
  void update(Timestamp now);

  // Returns the controls that have acted since the last call, in order: at most 16, later ones are
  // lost. Motions are not among them.
  std::vector<ControlId> takeActs();

  // The state that is drawn.
  bool byBall() const noexcept { return by_ball_; }
  std::optional<ControlId> hovered() const noexcept { return hovered_; }
  std::optional<ControlId> selected() const noexcept;  // the control that the ball has selected;
                                                       // nothing unless the ball operates the panel
  // The control pressed by the pointer, while it is still on it, or by the ball.
  std::optional<ControlId> pressed() const noexcept;
  // Returns whether the pointer's button is pressed, even if not on a control.
  bool isDown() const noexcept { return down_; }

  static constexpr Duration kRepeatAfter = std::chrono::milliseconds(500);
  static constexpr Duration kRepeatEvery = std::chrono::milliseconds(200);
  static constexpr Duration kForgotten = std::chrono::milliseconds(1500);
  static constexpr Duration kIdle = std::chrono::seconds(30);
  // A push of the ball beyond this share of full scale selects the next control; less than half of
  // it counts as let go.
  static constexpr float kPush = 0.3F;
  // The control that is selected when the ball begins to operate the panel: the middle of the
  // arrows.
  static constexpr ControlId kFirst = ControlId::kReset;

 private:
  struct Press {
    ControlId id;
    Timestamp heard;       // when the press was reported last
    Timestamp next_act{};  // kStep: when it acts again
  };
  void begin(std::optional<Press>& press, ControlId id, Timestamp now);
  void repeat(std::optional<Press>& press, Timestamp now);
  void select(int right, int down, Timestamp now);

  const PanelLayout& layout_;
  std::vector<ControlId> acts_;  // bounded: see takeActs()
  // The pointer
  std::optional<ControlId> hovered_;
  bool down_ = false;  // the pointer's button is pressed
  std::optional<Press> press_;
  // The ball
  bool by_ball_ = false;
  ControlId selected_ = kFirst;
  bool armed_ = false;  // the ball's buttons were released since it began to operate the panel
  std::optional<Press> ball_press_;
  std::optional<Timestamp> next_step_;  // while the ball is pushed: when the selection moves on
  Timestamp used_{};
};

}  // namespace merlin::render::panel
