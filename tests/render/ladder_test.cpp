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

TEST(Ladder, TenLateFramesInARowLeadARungDown) {
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

// How many frames, every `period`-th of which is late, lead a rung down; 0 where `most` do not.
int framesToStepDown(int period, int most) {
  Ladder ladder(1);
  for (int i = 1; i <= most; ++i) {
    if (ladder.observe(i % period == 0, true, true)) return i;
  }
  return 0;
}

TEST(Ladder, TheShareOfLateFramesDecidesHowSoonItGoesDown) {
  EXPECT_EQ(framesToStepDown(2, 100'000), 24);
  EXPECT_EQ(framesToStepDown(3, 100'000), 45);
  EXPECT_EQ(framesToStepDown(4, 100'000), 80);
  EXPECT_EQ(framesToStepDown(6, 100'000), 510);
  EXPECT_EQ(framesToStepDown(7, 100'000), 0) << "14 % are allowed";
  EXPECT_EQ(framesToStepDown(100, 100'000), 0) << "hiccups";
}

TEST(Ladder, LateFramesWithMoreThanTheFewestTakeNoEvidenceAway) {
  Ladder ladder(1);
  EXPECT_FALSE(observe(ladder, 9, true));
  EXPECT_FALSE(observe(ladder, 100, true, false));
  EXPECT_TRUE(observe(ladder, 1, true));
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
