// What gives way where not even the fewest triangles come in time.
#include "render/governor/ladder.h"

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

// Whether any of `count` such frames changed the rung.
bool observe(Ladder& ladder, int count, bool late, bool least = true, bool fits = true) {
  bool changed = false;
  for (int i = 0; i < count; ++i) changed |= ladder.observe(late, least, fits);
  return changed;
}

TEST(Ladder, TenLateOfSixtyLeadARungDown) {
  Ladder ladder(2);
  EXPECT_FALSE(observe(ladder, 9, true));
  EXPECT_EQ(ladder.rung(), 0);
  EXPECT_TRUE(observe(ladder, 1, true));
  EXPECT_EQ(ladder.rung(), 1);
  EXPECT_TRUE(observe(ladder, 10, true));
  EXPECT_EQ(ladder.rung(), 2);
  EXPECT_FALSE(observe(ladder, 100, true)) << "the last rung";
}

TEST(Ladder, NineLateInSixtyDoNot) {
  Ladder ladder(2);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(observe(ladder, 9, true));
    EXPECT_FALSE(observe(ladder, 51, false));
  }
}

TEST(Ladder, FramesWithMoreThanTheFewestAreTheGovernorsBusiness) {
  Ladder ladder(2);
  EXPECT_FALSE(observe(ladder, 100, true, false));
}

TEST(Ladder, ThreeHundredInTimeBringItBackIfItFitsThere) {
  Ladder ladder(2);
  observe(ladder, 10, true);
  EXPECT_FALSE(observe(ladder, 1000, false, true, false)) << "it would not fit";
  EXPECT_TRUE(observe(ladder, 1, false));
  EXPECT_EQ(ladder.rung(), 0);
  observe(ladder, 10, true);
  EXPECT_FALSE(observe(ladder, 299, false));
  EXPECT_FALSE(observe(ladder, 1, true)) << "one late frame starts the count again";
  EXPECT_FALSE(observe(ladder, 299, false));
  EXPECT_TRUE(observe(ladder, 1, false));
}

TEST(Ladder, HasAsManyRungsAsItIsGiven) {
  Ladder ladder(1);
  EXPECT_TRUE(observe(ladder, 10, true));
  EXPECT_FALSE(observe(ladder, 50, true));
  EXPECT_EQ(ladder.rung(), 1);
}

}  // namespace
}  // namespace merlin::render
