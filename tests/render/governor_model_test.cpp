// The governor's inputs other than frames: calibration, feed-forward, budgets set by a person,
// another rate; and how it learns its exponent.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/governed.h"

namespace merlin::render {
namespace {

using governed::budgetOf;
using governed::frame;
using governed::kSettings;
using governed::settled;
using std::chrono::milliseconds;

// Half the triangles, drawn in the rest of a period, follow the exponent 0.8, not 0.65: they are
// 0.5^0.15 = 0.9013 times as expensive as predicted. A tenth of the difference in the exponent is
// learnt; the prediction for the usual number of triangles is unchanged.
TEST(GovernorExponent, IsLearntFromAFrameThatHadLessTime) {
  governor::Governor governor = settled();
  EXPECT_DOUBLE_EQ(governor.exponent(), 0.65);
  const double usual = governor.predict(10'000);
  const double drawing = 0.032 * std::pow(0.5, 0.8);
  governor.observe(frame(5'000, milliseconds(4), fromSeconds(0.004 + drawing)));
  EXPECT_NEAR(governor.exponent(), 0.665, 1e-4);
  EXPECT_NEAR(governor.predict(10'000) / usual, 1, 1e-9);
  EXPECT_EQ(governor.budget(), 10'000u);
}

// The model has fewer triangles than would fit into the period, so all of its frames are below the
// budget.
TEST(GovernorExponent, IsNotLearntFromFramesThatAreAllSmall) {
  governor::Governor governor = settled();
  for (int i = 0; i < 50; ++i) governor.observe(frame(1'000, milliseconds(4), milliseconds(10)));
  EXPECT_NEAR(governor.exponent(), 0.65, 0.03);
  EXPECT_NEAR(governor.predict(1'000), 0.010, 2e-4);
}

std::vector<governor::FrameCost> sweep(double fixed_s, double c, double p) {
  std::vector<governor::FrameCost> frames;
  for (const std::size_t t : {1'000U, 4'000U, 16'000U, 64'000U}) {
    for (int i = 0; i < 3; ++i) {
      const double work = fixed_s + c * std::pow(static_cast<double>(t), p);
      frames.push_back({t, fromSeconds(fixed_s), fromSeconds(i == 1 ? work + 0.02 : work), false});
    }
  }
  return frames;
}

// One in three of these frames has a hiccup of 20 ms.
TEST(GovernorCalibration, FindsTheModelInSpiteOfHiccups) {
  for (const double p : {0.5, 0.62, 0.8, 1.0}) {
    governor::Governor governor(kSettings);
    const double c = 0.030 / std::pow(30'000, p);
    governor.calibrate(sweep(0.005, c, p));
    EXPECT_NEAR(governor.exponent(), p, 0.05) << p;
    EXPECT_DOUBLE_EQ(governor.fixedSeconds(), 0.005);
    // 40 ms x 0.9 - 5 ms = 31 ms are available, and 30,000 triangles take 30 ms: the budget is
    // within a tenth of 30,000 x (31 / 30)^(1 / p).
    EXPECT_NEAR(budgetOf(governor) / (30'000 * std::pow(31.0 / 30, 1 / p)), 1, 0.1) << p;
  }
}

TEST(GovernorCalibration, WithFramesOfOneSizeLeavesTheExponent) {
  governor::Governor governor(kSettings);
  governor.calibrate(
      std::vector<governor::FrameCost>(3, frame(10'000, milliseconds(4), milliseconds(36))));
  EXPECT_DOUBLE_EQ(governor.exponent(), 0.65);
  EXPECT_NEAR(budgetOf(governor), 10'000, 2);
  governor::Governor none(kSettings);
  none.calibrate({});
  EXPECT_EQ(none.budget(), 10'000u);
  EXPECT_EQ(none.coefficient(), 0);
}

// Drawing takes 32 ms; in three of five frames it takes 8 per cent more or less. The head room
// becomes 3 x 0.08, within its bounds.
TEST(GovernorCalibration, LeavesRoomForTheNoiseThatItSaw) {
  const auto noisy = [](double noise) {
    std::vector<governor::FrameCost> frames;
    for (const double off : {0.0, -noise, noise, noise, 0.0})
      frames.push_back(frame(10'000, milliseconds(4), fromSeconds(0.004 + 0.032 * std::exp(off))));
    governor::Governor governor(kSettings);
    governor.calibrate(frames);
    return governor.headRoom();
  };
  EXPECT_NEAR(noisy(0.08), 0.24, 1e-6);
  EXPECT_DOUBLE_EQ(noisy(0.01), 0.10);
  EXPECT_DOUBLE_EQ(noisy(0.50), 0.30);
}

// The view becomes twice as expensive: (32 / 64)^(1 / 0.65) = 0.34429. The governor reacts at once
// in both directions.
TEST(GovernorExpect, FeedsForwardAtOnce) {
  governor::Governor governor = settled();
  governor.expect(2);
  EXPECT_NEAR(budgetOf(governor), 3443, 2);
  governor.expect(0.5);
  EXPECT_NEAR(budgetOf(governor), 10'000, 2);
  governor::Governor fresh(kSettings);
  fresh.expect(3);
  EXPECT_EQ(fresh.budget(), 10'000u) << "nothing was measured yet";
}

TEST(GovernorHold, IsByHandUntilItIsGivenBack) {
  governor::Governor governor = settled();
  governor.hold(2'000);
  EXPECT_TRUE(governor.held());
  EXPECT_EQ(governor.budget(), 2'000u);
  EXPECT_EQ(governor.budgetFor(milliseconds(2)), 2'000u) << "whatever the time";
  for (int i = 0; i < 20; ++i) governor.observe(frame(2'000, milliseconds(4), milliseconds(60)));
  EXPECT_EQ(governor.budget(), 2'000u);
  governor.hold(50);
  EXPECT_EQ(governor.budget(), 100u) << "the least";
  governor.hold(std::nullopt);
  EXPECT_FALSE(governor.held());
  EXPECT_LT(governor.budget(), 1'000u) << "it has gone on learning";
}

// (80 ms x 0.9 - 4 ms) / 32 ms = 68 / 32; to the power of 1 / 0.65 this is 3.1888.
TEST(GovernorRate, AnotherPeriodIsFilledAtOnce) {
  governor::Governor governor = settled();
  governor.setRate(12.5);
  EXPECT_EQ(governor.period(), milliseconds(80));
  EXPECT_NEAR(budgetOf(governor), 31'888, 5);
  governor.setRate(25);
  EXPECT_NEAR(budgetOf(governor), 10'000, 2);
}

}  // namespace
}  // namespace merlin::render
