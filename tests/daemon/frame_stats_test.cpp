#include "daemon/wall/frame_stats.h"

#include <gtest/gtest.h>

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPeriod = milliseconds(25);

Timestamp at(int k) { return Timestamp(seconds(100)) + k * kPeriod; }

TEST(FrameStats, TheRateHeldIsTheShareOfDeadlinesMetInTheLastSecond) {
  FrameStats stats;
  for (int k = 1; k <= 40; ++k) stats.deadline(at(k), true, true);
  EXPECT_DOUBLE_EQ(stats.heldRate(at(40), 40), 40);
  for (int k = 41; k <= 80; ++k) stats.deadline(at(k), true, k % 4 != 0);
  EXPECT_DOUBLE_EQ(stats.heldRate(at(80), 40), 30);
}

TEST(FrameStats, LateSharesCountWhatMovedAndNothingElse) {
  FrameStats stats;
  // The first four deadlines are missed.
  for (int k = 1; k <= 40; ++k) stats.deadline(at(k), true, k > 4);
  for (int k = 41; k <= 4000; ++k) stats.deadline(at(k), false, true);  // 99 s without motion
  EXPECT_EQ(stats.deadlines(), 40u);
  EXPECT_EQ(stats.late(), 4u);
  EXPECT_EQ(stats.longestLate(), 4u);
  EXPECT_DOUBLE_EQ(stats.lateShare(at(41), seconds(60)), 0.1);
  stats.advance(at(4000));
  EXPECT_DOUBLE_EQ(stats.lateShare(at(4000), seconds(60)), 0);
}

TEST(FrameStats, TheLongestRunOfLateFramesIsOfOneRun) {
  FrameStats stats;
  const bool met[] = {false, false, true, false, false, false, true, false};
  for (int k = 0; k < 8; ++k) stats.deadline(at(k), true, met[k]);
  EXPECT_EQ(stats.longestLate(), 3u);
}

TEST(FrameStats, WorkIsTheMedianAndTheMeanShareOfTheLastSecond) {
  FrameStats stats;
  stats.frame(at(0), milliseconds(1000), kPeriod, 1000);  // more than a second before the others
  for (int k = 100; k < 105; ++k)
    stats.frame(at(k), milliseconds(k == 104 ? 45 : 20), kPeriod, 1000);
  stats.advance(at(105));
  EXPECT_DOUBLE_EQ(stats.medianWorkSeconds(), 0.020);
  // (4 x 0.8 + 1.8) / 5: 20 ms and 45 ms, in periods of 25 ms.
  EXPECT_DOUBLE_EQ(stats.utilisation(), 1.0);
}

// Two late frames, one in time, one late, then five in time: the step has settled after four
// frames.
TEST(FrameStats, AStepHasSettledWhenFiveInARowAreInTime) {
  FrameStats stats;
  int k = 0;
  const auto add = [&](std::initializer_list<bool> met) {
    for (const bool m : met) stats.deadline(at(++k), true, m);
  };
  add({true, false, true, true, true, true, true});
  EXPECT_EQ(stats.settleFrames(), 0u) << "one late frame is no step";
  add({false, false, true, false, true, true, true, true});
  EXPECT_EQ(stats.settleFrames(), 0u);
  add({true});
  EXPECT_EQ(stats.settleFrames(), 4u);
}

TEST(FrameStats, TheHistogramCountsWorkInSixteenthsOfThePeriod) {
  FrameStats stats;
  for (const int us : {0, 1562, 1563, 24999, 25000, 49999, 50000, 900000})
    stats.frame(at(1), std::chrono::microseconds(us), kPeriod, 1000);
  const auto& h = stats.histogram();
  EXPECT_EQ(h[0], 2u);
  EXPECT_EQ(h[1], 1u);
  EXPECT_EQ(h[15], 1u);
  EXPECT_EQ(h[16], 1u);
  EXPECT_EQ(h[31], 3u) << "and all that is longer";
}

// Of 100 frames 90 have 1,000 triangles and 10 have 2,000; the 5th and 95th percentiles are 1,000
// and 2,000.
TEST(FrameStats, OscillationIsTheSpreadOfTheLastHundredFrames) {
  FrameStats stats;
  for (int i = 0; i < 99; ++i) stats.frame(at(1), milliseconds(20), kPeriod, 500);
  EXPECT_EQ(stats.oscillation(), 0);
  for (int i = 0; i < 100; ++i) stats.frame(at(1), milliseconds(20), kPeriod, i < 90 ? 1000 : 2000);
  EXPECT_DOUBLE_EQ(stats.oscillation(), 1000.0 / 1100);
}

TEST(FrameStats, SayNothingBeforeAnythingHappened) {
  const FrameStats stats;
  EXPECT_EQ(stats.heldRate(at(0), 30), 0);
  EXPECT_EQ(stats.lateShare(at(0), seconds(1)), 0);
  EXPECT_EQ(stats.medianWorkSeconds(), 0);
}

}  // namespace
}  // namespace merlin::wall
