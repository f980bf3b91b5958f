// The rule for every benchmark: if its subject did not run, the benchmark prints no figure and
// fails.
#include "tests/bench/figures.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace merlin::bench {
namespace {

const auto kNothing = std::vector<double>{};

TEST(Figures, AFigureHasAtLeastOneMeasurement) {
  EXPECT_THROW(Measured::of(1, 0, "frames"), DidNotRun);
  EXPECT_THROW(shareOf(0, 0, "deadlines"), DidNotRun);
  EXPECT_THROW(medianOf(kNothing, "frames"), DidNotRun);
  EXPECT_THROW(quantileOf(kNothing, 0.99, "frames"), DidNotRun);
  EXPECT_THROW(meanOf(kNothing, "rounds"), DidNotRun);
  EXPECT_EQ(shareOf(1, 4, "deadlines"), 0.25);
  EXPECT_EQ(shareOf(1, 4, "deadlines").count(), 4U);
  EXPECT_EQ(medianOf({3, 1, 2}, "frames"), 2);
  EXPECT_EQ(meanOf({3, 1, 2, 2}, "rounds"), 2);
  EXPECT_EQ(meanOf({3, 1, 2, 2}, "rounds").count(), 4U);
}

TEST(Figures, AFigureIsAFiniteNumber) {
  const auto some = Measured::of(2, 5, "frames"), zero = Measured::of(0, 5, "frames");
  EXPECT_THROW(ratioOf(some, zero, "frames"), DidNotRun);
  EXPECT_THROW(ratioOf(zero, zero, "frames"), DidNotRun);
  EXPECT_THROW(Measured::of(std::nan(""), 5, "frames"), DidNotRun);
  EXPECT_EQ(ratioOf(zero, some, "frames"), 0);
  EXPECT_EQ(ratioOf(Measured::of(1, 3, "frames"), some, "frames").count(), 3U);
}

struct Said {
  int status;
  std::string output, message;
};

Said said(bool json, const std::function<bool(Report&)>& measure) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int status = runBench("sample", json, measure);
  std::string output = testing::internal::GetCapturedStdout();
  return {status, output, testing::internal::GetCapturedStderr()};
}

bool measureTwo(Report& report) {
  report.text("late {:.2f} %\n", 2.5);
  report.figure("late", Measured::of(0.025, 40, "deadlines"), "1");
  report.figure("frames", "00ff", 3);
  return true;
}

TEST(Figures, TextIsForPeopleAndOneObjectForPrograms) {
  EXPECT_EQ(said(false, measureTwo).output, "late 2.50 %\n");
  const auto object = nlohmann::json::parse(said(true, measureTwo).output);
  EXPECT_EQ(object["bench"], "sample");
  EXPECT_GE(object["machine"]["cores"], 1);
  EXPECT_EQ(object["figures"]["late"],
            (nlohmann::json{{"value", 0.025}, {"unit", "1"}, {"count", 40}}));
  EXPECT_EQ(object["figures"]["frames"], (nlohmann::json{{"value", "00ff"}, {"count", 3}}));
  EXPECT_EQ(said(true, measureTwo).status, 0);
}

TEST(Figures, WhoseSubjectDidNotRunPrintsNoFigureAndFails) {
  for (const bool json : {false, true}) {
    const Said s = said(json, [](Report& report) {
      measureTwo(report);  // this part of the measurement has run
      didNotRun("merlind", "it ended", "build it");
      return true;
    });
    EXPECT_EQ(s.status, 1);
    EXPECT_EQ(s.output, "");
    EXPECT_EQ(s.message, "bench sample: no figures: merlind: it ended; build it\n");
  }
}

TEST(Figures, WhatWasNotForeseenPrintsNoFigureAndFails) {
  const Said s = said(false, [](Report& report) {
    measureTwo(report);
    throw std::runtime_error("no such folder");
    return true;
  });
  EXPECT_EQ(s.status, 1);
  EXPECT_EQ(s.output, "");
  EXPECT_NE(s.message.find("no such folder"), std::string::npos);
}

TEST(Figures, ABenchmarkWithoutAFigureFails) {
  const Said s = said(false, [](Report& report) {
    report.text("a heading\n");
    return true;
  });
  EXPECT_EQ(s.status, 1);
  EXPECT_EQ(s.output, "");
}

TEST(Figures, ABrokenPromiseIsPrintedAndFails) {
  const Said s = said(false, [](Report& report) { return !measureTwo(report); });
  EXPECT_EQ(s.status, 1);
  EXPECT_EQ(s.output, "late 2.50 %\n");
}

std::vector<std::pair<double, double>> series(const std::function<double(int)>& value) {
  std::vector<std::pair<double, double>> points;
  for (int i = 0; i < 600; ++i) points.emplace_back(i, value(i));
  return points;
}

TEST(Slope, OfALineWithNoiseIsFoundAndIsBeyondChance) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.5);
  const Slope slope = slopeOf(series([&](int i) { return 200 + 0.01 * i + noise(random); }), "MiB");
  EXPECT_NEAR(slope.value, 0.01, 0.001);
  EXPECT_GT(slope.value - slope.half_width, 0);
}

TEST(Slope, OfNoiseIsWithinChanceInAbout39Of40Runs) {
  int beyond = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 0.5);
    const Slope slope = slopeOf(series([&](int) { return 200 + noise(random); }), "MiB");
    beyond += slope.value - slope.half_width > 0 ? 1 : 0;
  }
  EXPECT_LE(beyond, 12);
  EXPECT_GE(beyond, 1);
}

TEST(Slope, OfStepsUpAndDownIsWithinChanceSinceNeighboursAreAlike) {
  const Slope slope = slopeOf(series([](int i) { return 200 + 20 * (i / 150 % 2); }), "MiB");
  EXPECT_GT(slope.half_width, std::abs(slope.value));
}

TEST(Slope, OfFewerThanTenPointsIsNone) {
  auto points = series([](int) { return 1.0; });
  points.resize(9);
  EXPECT_THROW(slopeOf(points, "MiB"), DidNotRun);
}

}  // namespace
}  // namespace merlin::bench
