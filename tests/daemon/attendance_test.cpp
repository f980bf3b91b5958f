// What counts as a touch by a visitor, and which states of the wall end at a touch.
#include "daemon/wall/attendance.h"

#include <gtest/gtest.h>

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;
using Shown = Attendance::Shown;

class AttendanceTest : public testing::Test {
 protected:
  // Simulates a frame with `input_`, 20 ms after the previous frame; afterwards removes one-time
  // events from the input.
  Shown frame() {
    now_ += milliseconds(20);
    WallInput input = input_;
    attendance_.update(input, now_);
    input_.blank = input_.freeze = input_.snapshot = 0;
    input_.by_fingers = false;
    input_.next_content = input_.previous_content = 0;
    input_.scene.reset_view = input_.scene.next_mode = 0;
    input_.scene.step = {};
    input_.align.actions = {};
    return attendance_.shown();
  }
  Shown pass(Duration time) {
    Shown shown = attendance_.shown();
    for (const Timestamp end = now_ + time; now_ < end;) shown = frame();
    return shown;
  }
  void push(float by) {
    input_.scene.ball.emplace();
    input_.scene.ball->translation[0] = by;
  }
  void hold(float x_m) {
    input_.scene.grab = true;
    input_.scene.hand.emplace();
    input_.scene.hand->position_m[0] = x_m;
  }
  // Makes the wall black, at a time when nobody has touched anything for some time.
  void black() {
    input_ = {};
    attendance_.touch();
    pass(milliseconds(600));
    attendance_.toggleBlank();
    ASSERT_EQ(frame(), Shown::kBlank);
  }

  Attendance attendance_{{}};
  WallInput input_;
  Timestamp now_{std::chrono::seconds(100)};
};

TEST_F(AttendanceTest, EveryTouchShowsThePictureAgain) {
  const std::function<void()> touches[] = {
      [&] { push(0.1F); },
      [&] { input_.scene.held.nearer = 1; },
      [&] { input_.scene.ball.emplace().rotation[2] = -0.1F; },
      [&] { input_.scene.ball.emplace().buttons = 1U << 7; },
      [&] { input_.scene.step.way_m.x() = 0.1F; },
      [&] { input_.scene.step.turn_rad.y() = 0.1F; },
      [&] { input_.scene.reset_view = 1; },
      [&] { input_.scene.next_mode = 1; },
      [&] { input_.next_content = 1; },
      [&] { input_.previous_content = 1; },
      [&] { input_.snapshot = 1; },
      [&] { input_.align.actions = {2}; },
      [&] { input_.align.push.x = 0.5; },
      [&] { input_.scene.touch.fingers = 1; },
      [&] { input_.scene.touch.spread = -0.1F; },
      [&] { input_.scene.grab = true; },
      [&] { input_.scene.fly = true; },
      [&] { input_.scene.point_at = true; },
      [&] { attendance_.touch(); },
      [&] { attendance_.switchPlaylist(true); },
      [&] { attendance_.nextOfPlaylist(); },
  };
  for (std::size_t i = 0; i < std::size(touches); ++i) {
    black();
    touches[i]();
    EXPECT_EQ(frame(), Shown::kPicture) << i;
    EXPECT_EQ(pass(milliseconds(100)), Shown::kPicture) << i;
  }
}

TEST_F(AttendanceTest, NothingElseDoes) {
  black();
  push(0);
  hold(0);
  input_.scene.grab = false;
  input_.posture[0] = 'x';
  input_.head.emplace().position_m[0] = 1;
  EXPECT_EQ(pass(milliseconds(2000)), Shown::kBlank);
  attendance_.switchPlaylist(false);
  EXPECT_EQ(frame(), Shown::kBlank);
}

// Examples are a forgotten glass, or a marked object that stands on the surface permanently. The
// surface reports its position with some noise.
TEST_F(AttendanceTest, AFingerThatRestsIsATouchOnlyWhenItComesOrMoves) {
  black();
  input_.scene.touch.fingers = 1;
  EXPECT_EQ(frame(), Shown::kPicture) << "it comes";
  pass(milliseconds(600));
  attendance_.toggleBlank();
  for (int i = 0; i < 200; ++i) {
    input_.scene.touch.right = i % 2 == 0 ? 0.002F : -0.002F;
    ASSERT_EQ(frame(), Shown::kBlank) << i;
  }
  input_.scene.touch.right = 0.0006F;  // slowly: 3 % of the surface's height in a second
  EXPECT_EQ(pass(milliseconds(200)), Shown::kPicture);
  input_.scene.touch.right = 0;
  pass(milliseconds(600));
  attendance_.toggleBlank();
  EXPECT_EQ(pass(milliseconds(1000)), Shown::kBlank);
  input_.scene.touch.fingers = 0;
  EXPECT_EQ(pass(milliseconds(1000)), Shown::kBlank) << "it goes";
  input_.scene.touch.fingers = 1;
  EXPECT_EQ(frame(), Shown::kPicture) << "it comes again";
}

// A pinch is bound to blank or freeze. Long after the action, the fingers are lifted one after the
// other, and move meanwhile.
TEST_F(AttendanceTest, TheFingersThatMakeItBlackOrFrozenDoNotUndoItWhenTheyAreLifted) {
  for (const auto& [action, shown] : {std::pair(&WallInput::blank, Shown::kBlank),
                                      std::pair(&WallInput::freeze, Shown::kFrozen)}) {
    for (const milliseconds rest : {milliseconds(0), milliseconds(3000)}) {
      pass(milliseconds(600));
      input_.scene.touch.fingers = 2;
      input_.scene.touch.spread = -0.05F;
      pass(milliseconds(100));
      input_.*action = 1;
      input_.by_fingers = true;
      EXPECT_EQ(frame(), shown);
      EXPECT_EQ(pass(milliseconds(100)), shown) << "the pinch goes on";
      input_.scene.touch.spread = 0;
      EXPECT_EQ(pass(rest), shown);
      input_.scene.touch.right = 0.03F;
      EXPECT_EQ(frame(), shown) << "they move as they are lifted";
      input_.scene.touch.right = 0;
      input_.scene.touch.fingers = 1;
      EXPECT_EQ(pass(rest), shown);
      input_.scene.touch.right = 0.03F;
      EXPECT_EQ(frame(), shown) << "so does the last one";
      input_.scene.touch = {};
      EXPECT_EQ(pass(milliseconds(1000)), shown);
      input_.scene.touch.fingers = 1;
      EXPECT_EQ(frame(), Shown::kPicture) << "another finger comes";
      input_.scene.touch = {};
    }
  }
}

// A marked object may stand on the surface permanently.
TEST_F(AttendanceTest, AFingerThatComesBesideThoseOfTheGestureUndoesIt) {
  input_.scene.touch.fingers = 3;
  pass(milliseconds(600));
  input_.blank = 1;
  input_.by_fingers = true;
  ASSERT_EQ(frame(), Shown::kBlank);
  input_.scene.touch.fingers = 1;
  ASSERT_EQ(pass(milliseconds(600)), Shown::kBlank);
  input_.scene.touch.fingers = 2;
  EXPECT_EQ(frame(), Shown::kPicture);
}

// Fingers that are on the surface while a button makes the wall black do not belong to that action.
TEST_F(AttendanceTest, WhatStandsOnTheSurfaceWhenAButtonMakesItBlackUndoesItWhenItMoves) {
  input_.scene.touch.fingers = 1;
  pass(milliseconds(600));
  input_.blank = 1;
  ASSERT_EQ(frame(), Shown::kBlank);
  ASSERT_EQ(pass(milliseconds(1000)), Shown::kBlank);
  input_.scene.touch.right = 0.03F;
  EXPECT_EQ(frame(), Shown::kPicture);
}

// The first finger ends the black state; the gesture, complete a second later, must not make the
// wall black again.
TEST_F(AttendanceTest, TheGestureThatMadeItBlackMakesItLight) {
  const auto gesture = [&] {
    input_.scene.touch.fingers = 3;
    pass(milliseconds(1000));
    input_.blank = 1;
    input_.by_fingers = true;
    frame();
    pass(milliseconds(200));
    input_.scene.touch.fingers = 1;
    return pass(milliseconds(1000));
  };
  input_.scene.touch.fingers = 1;  // a marked object
  EXPECT_EQ(gesture(), Shown::kBlank);
  EXPECT_EQ(gesture(), Shown::kPicture);
  EXPECT_EQ(gesture(), Shown::kBlank);
}

// daemon/actions/README: a short press shows the next content, a long one makes the wall black.
TEST_F(AttendanceTest, TheLongPressThatMadeItBlackMakesItLight) {
  const auto press = [&] {
    input_.scene.ball.emplace().buttons = 5;
    pass(milliseconds(1500));
    input_.blank = 1;
    frame();
    pass(milliseconds(200));
    input_.scene.ball->buttons = 1;
    return pass(milliseconds(1000));
  };
  input_.scene.ball.emplace().buttons = 1;  // a button that is stuck
  EXPECT_EQ(press(), Shown::kBlank);
  EXPECT_EQ(press(), Shown::kPicture);
  EXPECT_EQ(press(), Shown::kBlank);
}

TEST_F(AttendanceTest, ABoundInputOfAnotherTouchThanTheOneThatEndedItActs) {
  black();
  push(1);
  ASSERT_EQ(pass(milliseconds(1000)), Shown::kPicture);
  input_.blank = 1;
  EXPECT_EQ(frame(), Shown::kBlank) << "the ball is still pushed";
  black();
  input_.scene.touch.fingers = 1;
  ASSERT_EQ(pass(milliseconds(1000)), Shown::kPicture);
  input_.blank = 1;
  EXPECT_EQ(frame(), Shown::kBlank) << "a button, while a finger rests";
  black();
  input_.scene.touch.fingers = 1;
  ASSERT_EQ(pass(milliseconds(1000)), Shown::kPicture);
  input_.freeze = 1;
  input_.by_fingers = true;
  EXPECT_EQ(frame(), Shown::kFrozen) << "it was black";
}

TEST_F(AttendanceTest, AFingerThatGoesEndsThePlaylist) {
  PlaylistSettings playlist;
  playlist.after_s = 60;
  attendance_.configure(playlist);
  input_.scene.touch.fingers = 1;
  frame();
  attendance_.switchPlaylist(true);
  pass(milliseconds(1000));
  ASSERT_EQ(attendance_.playlist(), Playlist::State::kRunning);
  input_.scene.touch.fingers = 0;
  frame();
  EXPECT_EQ(attendance_.playlist(), Playlist::State::kWaiting);
}

TEST_F(AttendanceTest, ASecondCallUndoesTheFirstAlsoInTheSameFrame) {
  attendance_.toggleFreeze();
  EXPECT_EQ(frame(), Shown::kFrozen);
  attendance_.toggleFreeze();
  EXPECT_EQ(frame(), Shown::kPicture);
  attendance_.toggleBlank();
  attendance_.toggleBlank();
  EXPECT_EQ(frame(), Shown::kPicture);
  input_.blank = 2;
  EXPECT_EQ(frame(), Shown::kPicture);
}

TEST_F(AttendanceTest, BlackIsAboveFrozen) {
  attendance_.toggleFreeze();
  frame();
  attendance_.toggleBlank();
  EXPECT_EQ(frame(), Shown::kBlank);
  EXPECT_TRUE(attendance_.isFrozen());
  attendance_.toggleBlank();
  EXPECT_EQ(frame(), Shown::kFrozen);
  attendance_.toggleBlank();
  frame();
  push(1);
  EXPECT_EQ(frame(), Shown::kPicture);
  EXPECT_FALSE(attendance_.isFrozen());
}

// If a visitor is turning the ball when the operator makes the wall black, going on with that turn
// must not end the black state.
TEST_F(AttendanceTest, AMotionThatGoesOnIsNoNewTouch) {
  push(1);
  pass(milliseconds(100));
  attendance_.toggleBlank();
  EXPECT_EQ(pass(milliseconds(3000)), Shown::kBlank);
  push(0);
  EXPECT_EQ(pass(milliseconds(400)), Shown::kBlank);
  push(1);
  EXPECT_EQ(frame(), Shown::kBlank) << "too short a pause";
  push(0);
  EXPECT_EQ(pass(milliseconds(500)), Shown::kBlank);
  push(1);
  EXPECT_EQ(frame(), Shown::kPicture);
}

// The button is reported together with its action, the ball trembles, and the button is released.
TEST_F(AttendanceTest, TheButtonThatMakesItBlackDoesNotUndoIt) {
  for (const Shown expected : {Shown::kBlank, Shown::kPicture}) {
    pass(milliseconds(600));
    input_.scene.ball.emplace().buttons = 1;
    input_.blank = 1;
    EXPECT_EQ(frame(), expected);
    input_.scene.ball->translation[1] = 0.05F;
    EXPECT_EQ(pass(milliseconds(200)), expected);
    input_.scene.ball.emplace();
    EXPECT_EQ(pass(milliseconds(700)), expected);
  }
}

// At a long press, the hand that releases the button shakes the ball, however late that is.
TEST_F(AttendanceTest, TheReleaseOfTheButtonThatMakesItBlackDoesNotUndoIt) {
  input_.scene.ball.emplace().buttons = 1;
  pass(milliseconds(1500));
  input_.blank = 1;
  EXPECT_EQ(frame(), Shown::kBlank);
  pass(milliseconds(2000));
  input_.scene.ball->buttons = 0;
  frame();
  input_.scene.ball->translation[1] = 0.05F;
  EXPECT_EQ(pass(milliseconds(100)), Shown::kBlank);
  push(0);
  pass(milliseconds(600));
  push(0.05F);
  EXPECT_EQ(frame(), Shown::kPicture);
}

TEST_F(AttendanceTest, TheActionMayComeAFrameBeforeItsButton) {
  input_.blank = 1;
  frame();
  input_.scene.ball.emplace().buttons = 1;
  EXPECT_EQ(pass(milliseconds(1000)), Shown::kBlank);
}

TEST_F(AttendanceTest, WorkThatIsNoTouchLeavesItBlack) {
  black();
  attendance_.attend();
  EXPECT_EQ(frame(), Shown::kBlank);
}

TEST_F(AttendanceTest, AButtonThatIsStuckIsOneTouch) {
  black();
  input_.scene.ball.emplace().buttons = 4;
  EXPECT_EQ(frame(), Shown::kPicture);
  pass(milliseconds(1000));
  attendance_.toggleBlank();
  EXPECT_EQ(pass(milliseconds(1000)), Shown::kBlank);
  input_.scene.ball->buttons = 4 | 1;
  EXPECT_EQ(frame(), Shown::kPicture);
}

TEST_F(AttendanceTest, AHandThatHoldsAnActionTouchesWhileItMoves) {
  hold(1);
  pass(milliseconds(1000));
  attendance_.toggleFreeze();
  frame();
  input_.scene.hand->position_m[0] = 1.015F;  // a tremor of the hand
  EXPECT_EQ(pass(milliseconds(1000)), Shown::kFrozen);
  input_.scene.hand->position_m[0] = 1.03F;
  EXPECT_EQ(frame(), Shown::kPicture);
}

TEST_F(AttendanceTest, WhileItIsBlackOrFrozenTheSceneGetsNoInput) {
  push(1);
  hold(1);
  pass(milliseconds(100));
  attendance_.toggleBlank();
  WallInput input = input_;
  EXPECT_TRUE(attendance_.update(input, now_ + milliseconds(20)).held);
  EXPECT_FALSE(input.scene.ball || input.scene.hand || input.scene.grab);
}

TEST_F(AttendanceTest, WhileItIsBlackOrFrozenNothingIsDue) {
  PlaylistSettings playlist;
  playlist.after_s = 60;
  playlist.dim_after_s = 300;
  attendance_.configure(playlist);
  pass(milliseconds(1000));
  EXPECT_NEAR(attendance_.due().begins_s, 59, 0.1);
  EXPECT_NEAR(attendance_.due().dims_s, 299, 0.1);
  for (const auto toggle : {&Attendance::toggleBlank, &Attendance::toggleFreeze}) {
    (attendance_.*toggle)();
    pass(milliseconds(1000));
    EXPECT_LT(attendance_.due().begins_s, 0) << "for the playlist no time passes";
    EXPECT_LT(attendance_.due().dims_s, 0);
    (attendance_.*toggle)();
    frame();
  }
  EXPECT_GT(attendance_.due().begins_s, 0);
}

TEST_F(AttendanceTest, TheTouchThatUndoesItMovesTheSceneAsEver) {
  black();
  push(0.5F);
  WallInput input = input_;
  EXPECT_FALSE(attendance_.update(input, now_ + milliseconds(20)).held);
  EXPECT_EQ(input.scene.ball->translation[0], 0.5F);
}

}  // namespace
}  // namespace merlin::wall
