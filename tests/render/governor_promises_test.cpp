// The limits that MERLIN states for its frame rate; ./dev bench governor prints these figures
// beside those of other control laws.
#include <gtest/gtest.h>

#include "tests/support/governor_plant.h"

namespace merlin::test {
namespace {

Outcome run(const Trace& trace, double hiccups, std::uint64_t seed = 4) {
  render::governor::Governor governor({});
  return runOnGrid(governor, {trace, seed, hiccups});
}

// Returns the mean over twenty seeds, since the number of hiccups in a minute is random.
double mean(double (*figure)(const Outcome&), const Trace& trace, double hiccups) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) sum += figure(run(trace, hiccups, seed));
  return sum / 20;
}

const std::pair<const char*, Trace> kTraces[] = {{"steady", steadyTrace()},
                                                 {"step of 2", stepTrace(2)},
                                                 {"step of 4", stepTrace(4)},
                                                 {"fixed part", stepTrace(1, 0.014)},
                                                 {"ramp", rampTrace()}};

TEST(GovernorPromise, AtMostThreeFramesInTwoHundredAreLateWithHiccups) {
  for (const auto& [name, trace] : kTraces) EXPECT_LE(mean(lateShare, trace, 0.01), 0.015) << name;
}

TEST(GovernorPromise, AtMostOneFrameInTwoHundredIsLateWithout) {
  for (const auto& [name, trace] : kTraces) EXPECT_LE(mean(lateShare, trace, 0), 0.005) << name;
}

TEST(GovernorPromise, SettlesWithinThreeFramesAfterAStepOfTwo) {
  EXPECT_LE(framesToSettle(run(stepTrace(2), 0)), 3u);
}

TEST(GovernorPromise, SettlesWithinFiveFramesAfterAStepOfFour) {
  EXPECT_LE(framesToSettle(run(stepTrace(4), 0)), 5u);
}

TEST(GovernorPromise, NoMoreThanThreeFramesInARowAreLate) {
  for (const auto& [name, trace] : kTraces) {
    EXPECT_LE(longestLate(run(trace, 0)), 3u) << name;
    EXPECT_LE(longestLate(run(trace, 0.01)), 3u) << name;
  }
}

TEST(GovernorPromise, NineTenthsOfTheDetailAreBackWithinFortyFrames) {
  EXPECT_LE(framesToRecover(run(stepTrace(2), 0)), 40u);
  EXPECT_LE(framesToRecover(run(stepTrace(4), 0)), 40u);
}

TEST(GovernorPromise, DetailSwingsByAtMostFivePerCent) {
  EXPECT_LE(mean(oscillation, steadyTrace(), 0.01), 0.05);
  EXPECT_LE(mean(oscillation, steadyTrace(), 0), 0.05);
}

TEST(GovernorPromise, MostOfThePeriodIsUsed) {
  EXPECT_GE(mean(utilisation, steadyTrace(), 0.01), 0.85);
  EXPECT_GE(mean(utilisation, stepTrace(2), 0.01), 0.85);
  EXPECT_GE(mean(utilisation, stepTrace(4), 0.01), 0.85);
  EXPECT_GE(mean(utilisation, rampTrace(), 0.01), 0.80);
}

// An initial exponent that is wrong by a third either way costs utilisation, but causes no late
// frames.
TEST(GovernorPromise, HoldsWithAnotherExponentThanItStartsWith) {
  for (const double p : {0.45, 1.0}) {
    render::governor::Governor governor({});
    const Outcome o = runOnGrid(governor, {stepTrace(2), 4, 0.01, p});
    EXPECT_LE(lateShare(o), 0.02) << p;
    EXPECT_GE(utilisation(o), 0.78) << p;
  }
}

}  // namespace
}  // namespace merlin::test
