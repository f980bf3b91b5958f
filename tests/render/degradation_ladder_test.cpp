// The steps by which the wall reduces its quality when frames are late even at the coarsest detail.
#include "render/governor/degradation_ladder.h"

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

// Observes `count` equal frames; returns whether any of them changed the step.
bool observe(governor::DegradationLadder& ladder, int count, bool late, bool least = true,
             bool fits = true) {
  bool changed = false;
  for (int i = 0; i < count; ++i) changed |= ladder.observe(late, least, fits);
  return changed;
}

TEST(DegradationLadder, TenLateFramesInARowLeadAStepDown) {
  governor::DegradationLadder ladder(2);
  EXPECT_FALSE(observe(ladder, 9, true));
  EXPECT_EQ(ladder.step(), 0);
  EXPECT_TRUE(observe(ladder, 1, true));
  EXPECT_EQ(ladder.step(), 1);
  EXPECT_TRUE(observe(ladder, 10, true));
  EXPECT_EQ(ladder.step(), 2);
  EXPECT_FALSE(observe(ladder, 100, true)) << "the last step";
}

TEST(DegradationLadder, NineLateInSixtyDoNot) {
  governor::DegradationLadder ladder(2);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(observe(ladder, 9, true));
    EXPECT_FALSE(observe(ladder, 51, false));
  }
}

// Returns the number of frames until the ladder steps down when every `period`-th frame is late; 0
// if it does not within `most` frames.
int framesToStepDown(int period, int most) {
  governor::DegradationLadder ladder(1);
  for (int i = 1; i <= most; ++i) {
    if (ladder.observe(i % period == 0, true, true)) return i;
  }
  return 0;
}

TEST(DegradationLadder, TheShareOfLateFramesDecidesHowSoonItGoesDown) {
  EXPECT_EQ(framesToStepDown(2, 100'000), 24);
  EXPECT_EQ(framesToStepDown(3, 100'000), 45);
  EXPECT_EQ(framesToStepDown(4, 100'000), 80);
  EXPECT_EQ(framesToStepDown(6, 100'000), 510);
  EXPECT_EQ(framesToStepDown(7, 100'000), 0) << "14 % are allowed";
  EXPECT_EQ(framesToStepDown(100, 100'000), 0) << "hiccups";
}

TEST(DegradationLadder, LateFramesWithMoreThanTheFewestTakeNoEvidenceAway) {
  governor::DegradationLadder ladder(1);
  EXPECT_FALSE(observe(ladder, 9, true));
  EXPECT_FALSE(observe(ladder, 100, true, false));
  EXPECT_TRUE(observe(ladder, 1, true));
}

TEST(DegradationLadder, FramesWithMoreThanTheFewestAreTheGovernorsBusiness) {
  governor::DegradationLadder ladder(2);
  EXPECT_FALSE(observe(ladder, 100, true, false));
}

TEST(DegradationLadder, ThreeHundredInTimeBringItBackIfItFitsThere) {
  governor::DegradationLadder ladder(2);
  observe(ladder, 10, true);
  EXPECT_FALSE(observe(ladder, 1000, false, true, false)) << "it would not fit";
  EXPECT_TRUE(observe(ladder, 1, false));
  EXPECT_EQ(ladder.step(), 0);
  observe(ladder, 10, true);
  EXPECT_FALSE(observe(ladder, 299, false));
  EXPECT_FALSE(observe(ladder, 1, true)) << "one late frame starts the count again";
  EXPECT_FALSE(observe(ladder, 299, false));
  EXPECT_TRUE(observe(ladder, 1, false));
}

TEST(DegradationLadder, HasAsManyStepsAsItIsGiven) {
  governor::DegradationLadder ladder(1);
  EXPECT_TRUE(observe(ladder, 10, true));
  EXPECT_FALSE(observe(ladder, 50, true));
  EXPECT_EQ(ladder.step(), 1);
}

}  // namespace
}  // namespace merlin::render
