// A wall whose content has been moved out of sight, on a virtual clock.
#include <gtest/gtest.h>

#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

class WallReturnTest : public FakeWall {
 protected:
  WallReturnTest() {
    feed_.pushed = false;
    painter_.furthest_seen_m = 5;
    return_after_s_ = 60;
  }
  // The hand grabs the content after a second, is 3 m further away a moment later, and releases the
  // content there.
  void carryAway(Timestamp now) {
    const double s = toSeconds(now - feed_.begins.front());
    feed_.actions.scene.grab = s > 1 && s < 2;
    feed_.hand.emplace();
    feed_.hand->position_m[0] = s < 1.5 ? 1 : 4;
    feed_.hand->orientation_wxyz[0] = 1;
  }
  float away() const { return scene_.view().T_eye_model.translation().norm(); }
};

TEST_F(WallReturnTest, TheStartViewReturnsAfterAMinuteThatShowsNothing) {
  float before = 0;
  run(63, [&](Timestamp now) {
    carryAway(now);
    if (now - feed_.begins.front() < std::chrono::seconds(61)) before = away();
  });
  EXPECT_GT(before, 5);
  EXPECT_NEAR(away(), 2, 1e-4);
  EXPECT_EQ(stats().returned, 1u);
}

TEST_F(WallReturnTest, NotWhereItIsSwitchedOff) {
  return_after_s_ = 0;
  run(130, [&](Timestamp now) { carryAway(now); });
  EXPECT_GT(away(), 5);
  EXPECT_EQ(stats().returned, 0u);
}

TEST_F(WallReturnTest, NotWhileItIsSeen) {
  painter_.furthest_seen_m = 50;
  run(130, [&](Timestamp now) { carryAway(now); });
  EXPECT_GT(away(), 5);
  EXPECT_EQ(stats().returned, 0u);
}

}  // namespace
}  // namespace merlin::wall
