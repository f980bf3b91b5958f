#include "render/scene/lost_view.h"

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

class LostViewTest : public testing::Test {
 protected:
  // Updates the detector `s` seconds later; returns its answer.
  bool after(double s, bool seen, bool moving = false) {
    now_ += fromSeconds(s);
    return lost_.update(seen, moving, now_);
  }
  scene::LostView lost_{60};
  Timestamp now_{std::chrono::hours(1)};
};

TEST_F(LostViewTest, IsDueOnceAfterItsTimeUnseen) {
  EXPECT_FALSE(after(0, true));
  EXPECT_FALSE(after(1000, true));
  EXPECT_FALSE(after(59, false));
  EXPECT_TRUE(after(1, false));
  EXPECT_FALSE(after(1000, false));
}

TEST_F(LostViewTest, WaitsForWhoeverMovesIt) {
  EXPECT_FALSE(after(0, true));
  EXPECT_FALSE(after(100, false, true));
  EXPECT_TRUE(after(1, false));
}

TEST_F(LostViewTest, BeginsAgainWithEachSight) {
  EXPECT_FALSE(after(0, true));
  EXPECT_FALSE(after(59, false));
  EXPECT_FALSE(after(1, true));
  EXPECT_FALSE(after(59, false));
  EXPECT_TRUE(after(2, false));
  EXPECT_FALSE(after(1, true));
  EXPECT_TRUE(after(60, false));
}

TEST_F(LostViewTest, OfAStartViewThatShowsNothingNeverReturns) { EXPECT_FALSE(after(1000, false)); }

TEST_F(LostViewTest, OffNeverReturns) {
  lost_ = scene::LostView(0);
  EXPECT_FALSE(after(0, true));
  EXPECT_FALSE(after(1e6, false));
}

}  // namespace
}  // namespace merlin::render
