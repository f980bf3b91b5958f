// The governor's rules one by one, with frames whose cost is stated literally.
#include "render/governor/governor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "tests/render/governed.h"

namespace merlin::render {
namespace {

using governed::budgetOf;
using governed::frame;
using governed::kSettings;
using governed::settled;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

TEST(Governor, StartsWithWhatItIsTold) {
  const governor::Governor governor(kSettings);
  EXPECT_EQ(governor.budget(), 10'000u);
  EXPECT_EQ(governor.budgetFor(milliseconds(1)), 10'000u) << "nothing was measured yet";
  EXPECT_EQ(governor.budgetFor(Duration::zero()), 10'000u);
  EXPECT_EQ(governor.period(), milliseconds(40));
  EXPECT_EQ(governor.coefficient(), 0);
}

// The model is 4 ms + c T^0.65 with c from one frame: twice the triangles take 2^0.65 = 1.5692
// times as long.
TEST(Governor, PredictsByTheModel) {
  governor::Governor governor(kSettings);
  governor.observe(frame(10'000, milliseconds(4), milliseconds(14)));
  EXPECT_DOUBLE_EQ(governor.fixedSeconds(), 0.004);
  EXPECT_NEAR(governor.predict(10'000), 0.014, 1e-12);
  EXPECT_NEAR(governor.predict(20'000), 0.004 + 0.0156917, 1e-7);
  EXPECT_NEAR(governor.predict(0), 0.004, 1e-12);
}

// The late frame raises the head room to 0.1 + 0.01683. (40 ms x 0.88317 - 4 ms) / 60 ms = 0.52211;
// to the power of 1 / 0.65 this is 0.36795.
TEST(Governor, ShrinksAtOnceToWhatTheModelSaysFits) {
  governor::Governor governor(kSettings);
  governor.observe(frame(10'000, milliseconds(4), milliseconds(64)));
  EXPECT_NEAR(budgetOf(governor), 3680, 2);
}

TEST(Governor, GrowsByEightPercentAFrameAtMost) {
  governor::Governor governor(kSettings);
  for (int i = 1; i <= 20; ++i) {
    governor.observe(frame(10'000, milliseconds(0), milliseconds(1)));
    EXPECT_NEAR(budgetOf(governor), 10'000 * std::pow(1.08, i), 1) << i;
  }
}

// 36 ms is the target; a gain of less than 5 per cent of the triangles is not worth a change.
TEST(Governor, WaitsForAGainWorthIt) {
  EXPECT_EQ(settled().budget(), 10'000u);
  governor::Governor near(kSettings);
  near.observe(frame(10'000, milliseconds(0), milliseconds(35)));  // 4.4 per cent more would fit
  EXPECT_EQ(near.budget(), 10'000u);
  governor::Governor further(kSettings);
  further.observe(frame(10'000, milliseconds(0), milliseconds(34)));  // 9.2 per cent more would fit
  EXPECT_EQ(further.budget(), 10'800u);
}

TEST(Governor, OneHiccupChangesNothing) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(79)));
  EXPECT_DOUBLE_EQ(governor.coefficient(), before);
  EXPECT_EQ(governor.budget(), 10'000u);
  for (int i = 0; i < 5; ++i) {
    governor.observe(frame(10'000, milliseconds(4), milliseconds(36)));
    EXPECT_NEAR(governor.coefficient() / before, 1, 1e-9);
    EXPECT_EQ(governor.budget(), 10'000u);
  }
}

TEST(Governor, AHiccupNowAndThenChangesNothingEither) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  for (int i = 0; i < 200; ++i) {
    const int work = i % 20 == 0 ? 79 : 36;
    governor.observe({10'000, milliseconds(4), milliseconds(work), false});
    EXPECT_NEAR(governor.coefficient() / before, 1, 1e-9) << i;
  }
  EXPECT_EQ(governor.budget(), 10'000u);
}

// 96 ms of drawing are three times the usual 32 ms. A frame that misses two deadlines is taken as a
// change of the load, with 6 per cent added for its noise. (40 ms x 0.8901 - 4 ms) / (1.06 x 96 ms)
// = 0.31058; to the power of 1 / 0.65 this is 0.16561.
TEST(Governor, AFrameThatMissesTwoDeadlinesActsAlone) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(100)));
  EXPECT_NEAR(governor.coefficient() / before, 3 * 1.06, 1e-9);
  EXPECT_NEAR(budgetOf(governor), 1632, 2);
  governor.observe(frame(1632, milliseconds(4), milliseconds(35)));  // as the model predicts
  EXPECT_NEAR(governor.coefficient() / before, 3 * 1.06, 0.1);
  EXPECT_LT(governor.budget(), 2000u);
}

TEST(Governor, ALongHiccupIsTakenBackByTheNextFrame) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(400)));
  EXPECT_NEAR(governor.coefficient() / before, 6, 1e-9) << "at most";
  const std::size_t shown = governor.budget();
  EXPECT_NEAR(static_cast<double>(shown), 615, 3);
  const Duration work = fromSeconds(0.004 + before * std::pow(shown, 0.65));
  governor.observe(frame(shown, milliseconds(4), work));
  EXPECT_NEAR(governor.coefficient() / before, 1, 1e-6);
  EXPECT_EQ(governor.budget(), 10'000u);
}

// After two late frames in a row, the budget follows at once the lower of the two costs seen (56 /
// 32), with the learnt head room subtracted.
TEST(Governor, TwoLateInARowActAtOnceOnTheWorstSeen) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(68)));
  governor.observe(frame(10'000, milliseconds(4), milliseconds(60)));
  EXPECT_NEAR(governor.coefficient() / before, 56.0 / 32.0, 1e-9);
  EXPECT_NEAR(governor.headRoom(), 0.11683, 1e-9) << "the second is the load, not noise";
  EXPECT_NEAR(governor.predict(governor.budget()), 0.040 * (1 - 0.11683), 1e-5);
  governor.observe({10'000, milliseconds(4), milliseconds(20), true});
  EXPECT_NEAR(governor.coefficient() / before, 56.0 / 32.0, 1e-9) << "no better figure when late";
}

TEST(Governor, TheFirstLateFrameTeachesNothing) {
  governor::Governor governor = settled();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(39)));
  const double before = governor.coefficient();
  governor.observe(frame(10'000, milliseconds(4), milliseconds(70)));
  EXPECT_DOUBLE_EQ(governor.coefficient(), before);
}

// At 31.5 ms of 32 ms, 2.4 per cent more triangles would fit, which is not worth a change. With the
// head room after a late frame, 0.8 per cent fewer fit: (40 ms x 0.88317 - 4 ms) / 31.5 ms =
// 0.99450.
TEST(Governor, TwoLateInARowDoNotWaitForALossWorthIt) {
  const Duration work = std::chrono::microseconds(35'500);
  governor::Governor governor = settled();
  for (int i = 0; i < 200; ++i) governor.observe(frame(10'000, milliseconds(4), work));
  EXPECT_EQ(governor.budget(), 10'000u);
  for (int i = 0; i < 2; ++i) governor.observe({10'000, milliseconds(4), work, true});
  EXPECT_NEAR(budgetOf(governor), 9916, 3);
}

// Something other than the load made the frames late. More triangles would fit, but the budget must
// not grow after two late frames.
TEST(Governor, TwoLateInARowNeverGrow) {
  governor::Governor governor(kSettings);
  for (int i = 0; i < 10; ++i) governor.observe({10'000, {}, milliseconds(1), true});
  EXPECT_EQ(governor.budget(), 10'800u) << "by the first of them";
  governor.observe({10'000, {}, milliseconds(1), false});
  EXPECT_EQ(governor.budget(), 11'664u);
}

// The fixed part is the median of three values, smoothed by 0.15 a frame, so a single slow
// read-back has no effect.
TEST(Governor, SmoothsTheFixedPart) {
  governor::Governor governor = settled();
  governor.observe(frame(10'000, milliseconds(8), milliseconds(36)));
  EXPECT_NEAR(governor.fixedSeconds(), 0.0040, 1e-12);
  governor.observe(frame(10'000, milliseconds(8), milliseconds(36)));
  EXPECT_NEAR(governor.fixedSeconds(), 0.0046, 1e-12);
}

TEST(Governor, TwoThatBeganLateCountAlthoughTheirWorkFits) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  for (int i = 0; i < 2; ++i) governor.observe({10'000, milliseconds(4), milliseconds(39), true});
  EXPECT_NEAR(governor.coefficient() / before, 35.0 / 32.0, 1e-9);
}

// Work beyond the period counts as late even if the frame was shortened and came in time.
TEST(Governor, TwoThatRanOverInARowCountAsLate) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  for (int i = 0; i < 2; ++i) {
    governor.observe({10'000, milliseconds(4), milliseconds(68), false});
  }
  EXPECT_NEAR(governor.coefficient() / before, 2, 1e-9);
  EXPECT_NEAR(governor.headRoom(), 0.10, 1e-12) << "and the share of late frames is not touched";
}

// With 3 per cent of noise the budget stays the same, so the image does not change visibly.
TEST(Governor, KeepsStillWithinTheNoise) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const double work = 0.004 + 0.0315 * std::exp(0.03 * random.normal());
    governor.observe({10'000, milliseconds(4), fromSeconds(work), false});
    ASSERT_EQ(governor.budget(), 10'000u) << i;
  }
  EXPECT_NEAR(governor.coefficient() / before, 31.5 / 32, 0.01);
}

// For a second, each frame costs 2 per cent more than the one before; the model's error must stay
// below 9 per cent.
TEST(Governor, FollowsALoadThatRisesWithoutLagging) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  for (int i = 1; i <= 30; ++i) {
    const double load = std::pow(1.02, i);
    const double drawing = 0.032 * load * std::pow(budgetOf(governor) / 1e4, 0.65);
    governor.observe(frame(governor.budget(), milliseconds(4), fromSeconds(0.004 + drawing)));
    EXPECT_GT(governor.coefficient() / before, load / 1.085) << i;
    EXPECT_LT(governor.coefficient() / before, load * 1.085) << i;
  }
}

TEST(Governor, TakesACheaperLoadAtItsWordAndNoFurther) {
  governor::Governor governor = settled();
  const double before = governor.coefficient();
  for (int i = 0; i < 60; ++i) {
    const double drawing = 0.008 * std::pow(budgetOf(governor) / 1e4, 0.65);
    governor.observe(frame(governor.budget(), milliseconds(4), fromSeconds(0.004 + drawing)));
    EXPECT_GE(governor.coefficient() / before, 0.238) << i;
  }
  EXPECT_NEAR(governor.coefficient() / before, 0.25, 0.02);
}

TEST(Governor, HeadRoomFollowsTheShareOfFramesThatAreLateAlone) {
  governor::Governor governor(kSettings);
  EXPECT_DOUBLE_EQ(governor.headRoom(), 0.10);
  governor.observe({1000, {}, milliseconds(50), true});
  EXPECT_NEAR(governor.headRoom(), 0.10 + 0.017 * 0.99, 1e-12);
  governor.observe({1000, {}, milliseconds(50), true});
  EXPECT_NEAR(governor.headRoom(), 0.10 + 0.017 * 0.99, 1e-12) << "in a row";
  governor.observe({1000, {}, milliseconds(30), false});
  EXPECT_NEAR(governor.headRoom(), 0.10 + 0.017 * 0.99 - 0.017 * 0.01, 1e-12);
  for (int i = 0; i < 50; ++i) {
    governor.observe({1000, {}, milliseconds(30), false});
    governor.observe({1000, {}, milliseconds(50), true});
  }
  EXPECT_DOUBLE_EQ(governor.headRoom(), 0.30);
  for (int i = 0; i < 2000; ++i) governor.observe({1000, {}, milliseconds(30), false});
  EXPECT_NEAR(governor.headRoom(), 0.10, 1e-9);
}

TEST(Governor, KeepsTheLeastAndTheMost) {
  governor::Governor governor(kSettings);
  for (int i = 0; i < 100; ++i) governor.observe(frame(100, milliseconds(39), hours(1)));
  EXPECT_EQ(governor.budget(), 100u);
  for (int i = 0; i < 2000; ++i) governor.observe(frame(100, {}, nanoseconds(1)));
  EXPECT_EQ(governor.budget(), 1'000'000u);
}

// A content whose detail has another unit has its own minimum: a budget of 100 units may already be
// fine detail of a picture. A minimum above the configured one is ignored.
TEST(Governor, KeepsTheLeastOfAContentWithAnotherUnit) {
  governor::Governor governor = settled();
  governor.setLeastUseful(16);
  EXPECT_EQ(governor.least(), 16u);
  for (int i = 0; i < 100; ++i) governor.observe(frame(16, milliseconds(39), hours(1)));
  EXPECT_EQ(governor.budget(), 16u);
  governor.setLimits(kSettings);
  EXPECT_EQ(governor.budget(), 16u) << "other settings do not change what is shown";
  governor.hold(20);
  EXPECT_EQ(governor.budget(), 20u);
  governor.hold(std::nullopt);
  governor.setLeastUseful(5000);
  EXPECT_EQ(governor.least(), 100u);
  EXPECT_EQ(governor.budget(), 100u) << "at once";
  governor.setLeastUseful(16);
  governor.setLeastUseful(std::nullopt);
  EXPECT_EQ(governor.budget(), 100u);
}

TEST(GovernorBudgetFor, IsTheBudgetForAWholePeriod) {
  const governor::Governor governor = settled();
  EXPECT_EQ(governor.budgetFor(milliseconds(40)), governor.budget());
  EXPECT_EQ(governor.budgetFor(milliseconds(60)), governor.budget());
  // The frame started slightly late.
  EXPECT_EQ(governor.budgetFor(nanoseconds(39'600'000)), governor.budget());
}

// (20 ms x 0.9 - 4 ms) / 32 ms = 0.4375; to the power of 1 / 0.65 this is 0.28041.
TEST(GovernorBudgetFor, IsWhatTheModelSaysFits) {
  EXPECT_NEAR(static_cast<double>(settled().budgetFor(milliseconds(20))), 2804, 1);
}

TEST(GovernorBudgetFor, IsNoneWhereNotEvenTheLeastFits) {
  const governor::Governor governor = settled();
  // 0.5 ms are left, and 100 triangles take 1.6 ms.
  EXPECT_EQ(governor.budgetFor(milliseconds(5)), 0u);
  EXPECT_EQ(governor.budgetFor(milliseconds(4)), 0u);
  EXPECT_EQ(governor.budgetFor(Duration::zero()), 0u);
  EXPECT_EQ(governor.budgetFor(-milliseconds(100)), 0u);
  for (int us = 0; us < 40'000; us += 10) {
    const std::size_t fits = governor.budgetFor(std::chrono::microseconds(us));
    ASSERT_TRUE(fits == 0 || (fits >= 100 && fits <= governor.budget())) << us;
    if (fits == 0 || us >= 39'600) continue;
    ASSERT_LE(governor.predict(fits), 0.9 * us * 1e-6 + 1e-9) << us;
    ASSERT_GT(governor.predict(fits + 1), std::min(0.9 * us * 1e-6, governor.predict(10'000)));
  }
}

// Frame costs from the whole range of Duration.
TEST(Governor, StaysFiniteWhateverIsObserved) {
  const Duration times[] = {nanoseconds(1), nanoseconds(1000), milliseconds(40), hours(1),
                            hours(24 * 365 * 200)};
  const std::size_t counts[] = {0, 1, 10'000, std::numeric_limits<std::size_t>::max()};
  Random random(1);
  for (int run = 0; run < 200; ++run) {
    governor::Governor governor(kSettings);
    for (int i = 0; i < 50; ++i) {
      const Duration work = times[random.below(5)];
      const Duration fixed = random.below(2) == 0 ? Duration::zero() : work;
      governor.observe({counts[random.below(4)], fixed, work, random.below(2) == 0});
      ASSERT_GE(governor.budget(), 100u);
      ASSERT_LE(governor.budget(), 1'000'000u);
      ASSERT_TRUE(std::isfinite(governor.coefficient()) && governor.coefficient() > 0);
      ASSERT_TRUE(std::isfinite(governor.fixedSeconds()) && governor.fixedSeconds() >= 0);
      ASSERT_TRUE(std::isfinite(governor.predict(counts[random.below(4)])));
      ASSERT_TRUE(governor.headRoom() >= 0.10 && governor.headRoom() <= 0.30);
      for (const Duration t : times) ASSERT_LE(governor.budgetFor(t), governor.budget());
    }
  }
}

TEST(GovernorDeathTest, RefusesSettingsThatMakeNoSense) {
  EXPECT_DEBUG_DEATH(governor::Governor({.rate_hz = 0}), "rate_hz");
  EXPECT_DEBUG_DEATH(governor::Governor({.min_triangles = 0}), "min_triangles");
  EXPECT_DEBUG_DEATH(governor::Governor({.max_triangles = 9'000}), "max_triangles");
  EXPECT_DEBUG_DEATH(governor::Governor({.late_share = 0}), "late_share");
}

}  // namespace
}  // namespace merlin::render
