// Computes a station's alignment and boresight from the places where a person holds it. The samples
// may be in any frame of the unit.
#include "drivers/fastrak/guided_alignment.h"

#include <cmath>

#include <gtest/gtest.h>

namespace merlin::fastrak {
namespace {

using Place = std::array<float, 3>;
using Pose = std::array<float, 4>;

// Returns a sample of a unit without alignment and boresight: position in cm, orientation as a
// quaternion.
TrackerSample at(const Place& cm, const Pose& wxyz = {1, 0, 0, 0}) {
  TrackerSample s{};
  for (std::size_t i = 0; i < 3; ++i) s.position_m[i] = cm[i] / 100;
  std::copy(wxyz.begin(), wxyz.end(), s.orientation_wxyz);
  s.error = ' ';
  return s;
}

// A frame in which new x is old y, new y is old -x and new z is old z. Its origin is 50 cm in front
// of the transmitter; its boresight is a rotation of 90 degrees about z. turned() returns the
// sample that a place and pose give in this frame.
constexpr StationFrame kTurned{{50, 0, 0, 50, 100, 0, -50, 0, 0}, {0.70710678F, 0, 0, 0.70710678F}};
TrackerSample turned(const Place& cm, const Pose& wxyz = {1, 0, 0, 0}) {
  TrackerSample s = at({cm[1], 50 - cm[0], cm[2]});
  // q becomes conj(90 degrees about z) * q * conj(90 degrees about z).
  const auto [w, x, y, z] = wxyz;
  const Pose seen = {z, x, y, -w};
  std::copy(seen.begin(), seen.end(), s.orientation_wxyz);
  return s;
}

Result<HeldPose> hold(GuidedAlignment& guided, std::size_t step, const TrackerSample& sample) {
  guided.begin(step);
  for (int i = 0; i < 10; ++i) guided.add(sample);
  return guided.end();
}

constexpr Place kO = {60, 5, -15}, kX = {60, 45, -15}, kY = {30, 10, -15}, kA = {45, 20, -15};
constexpr Pose k40 = {0.93969262F, 0, 0, 0.34202014F};  // 40 degrees about z

void expectNear(const StationFrame& f, const std::array<float, 9>& cm, const Pose& wxyz) {
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(f.alignment_cm[i], cm[i], 0.011) << i;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(f.boresight_wxyz[i], wxyz[i], 1e-4) << i;
}

TEST(GuidedAlignment, PlacesMakeTheFrameAndThePoseIsAheadInIt) {
  GuidedAlignment guided({});
  ASSERT_TRUE(hold(guided, kOrigin, at(kO)));
  ASSERT_TRUE(hold(guided, kOnX, at(kX)));
  ASSERT_TRUE(hold(guided, kOnY, at(kY)));
  ASSERT_TRUE(hold(guided, kAhead, at(kA, k40)));
  // The new x axis is the old y, so of 40 degrees, -50 degrees remain.
  const Pose left = {0.90630779F, 0, 0, -0.42261826F};
  expectNear(guided.solve(), {60, 5, -15, 60, 45, -15, 30, 10, -15}, left);
}

TEST(GuidedAlignment, WhatIsInForceIsUndone) {
  GuidedAlignment guided(kTurned);
  ASSERT_TRUE(hold(guided, kOrigin, turned(kO)));
  ASSERT_TRUE(hold(guided, kOnX, turned(kX)));
  ASSERT_TRUE(hold(guided, kOnY, turned(kY)));
  const auto ahead = hold(guided, kAhead, turned(kA, k40));
  ASSERT_TRUE(ahead) << ahead.error().what;
  EXPECT_NEAR(ahead->position_m[0], 0.45, 1e-6);
  EXPECT_NEAR(ahead->position_m[1], 0.20, 1e-6);
  EXPECT_NEAR(std::abs(ahead->orientation_wxyz[3]), 0.34202, 1e-5);
  expectNear(guided.solve(), {60, 5, -15, 60, 45, -15, 30, 10, -15},
             {0.90630779F, 0, 0, -0.42261826F});
}

TEST(GuidedAlignment, ABoresightAloneKeepsTheAlignment) {
  GuidedAlignment guided(kTurned);
  ASSERT_TRUE(hold(guided, kAhead, turned(kA, k40)));
  expectNear(guided.solve(), kTurned.alignment_cm, {0.90630779F, 0, 0, -0.42261826F});
}

TEST(GuidedAlignment, AnAlignmentAloneKeepsWhatIsAhead) {
  GuidedAlignment guided({FastrakSettings::kAligned, k40});
  const auto seen = [](const Place& cm) { return at(cm, {0.93969262F, 0, 0, -0.34202014F}); };
  ASSERT_TRUE(hold(guided, kOrigin, seen(kO)));
  ASSERT_TRUE(hold(guided, kOnX, seen(kX)));
  ASSERT_TRUE(hold(guided, kOnY, seen(kY)));
  expectNear(guided.solve(), {60, 5, -15, 60, 45, -15, 30, 10, -15},
             {0.90630779F, 0, 0, -0.42261826F});
  GuidedAlignment plain({});
  for (const auto& [step, place] : {std::pair(kOrigin, kO), {kOnX, kX}, {kOnY, kY}})
    ASSERT_TRUE(hold(plain, step, at(place)));
  EXPECT_EQ(plain.solve().boresight_wxyz, FastrakSettings::kAhead);
}

TEST(GuidedAlignment, SaysHowFarTheFurthestSampleWas) {
  GuidedAlignment guided({});
  guided.begin(kOrigin);
  guided.add(at({60, 5, -15}));
  guided.add(at({60.6F, 5, -15}, {-1, 0, 0, 0}));  // the negated quaternion is the same orientation
  guided.add(at({59.4F, 5, -15}));
  const auto held = guided.end();
  ASSERT_TRUE(held) << held.error().what;
  EXPECT_EQ(held->samples, 3);
  EXPECT_NEAR(held->position_m[0], 0.6, 1e-6);
  EXPECT_NEAR(held->spread_m, 0.006, 1e-6);
  EXPECT_NEAR(held->spread_rad, 0, 1e-3);
}

TEST(GuidedAlignment, WhatMovesIsRefused) {
  GuidedAlignment guided({});
  guided.begin(kOrigin);
  for (const float x : {60.F, 60.F, 61.6F}) guided.add(at({x, 5, -15}));
  EXPECT_EQ(guided.end().error().what,
            "it moved by 1.1 cm and 0.0 degrees (1 cm and 3 degrees are allowed): hold it still");
  guided.begin(kAhead);
  for (const Pose& q : {Pose{1, 0, 0, 0}, Pose{1, 0, 0, 0}, k40}) guided.add(at(kO, q));
  EXPECT_EQ(guided.end().error().what,
            "it moved by 0.0 cm and 26.7 degrees (1 cm and 3 degrees are allowed): hold it still");
}

TEST(GuidedAlignment, PlacesThatMakeNoFrameAreRefused) {
  GuidedAlignment guided({});
  ASSERT_TRUE(hold(guided, kOrigin, at(kO)));
  EXPECT_EQ(hold(guided, kOnX, at({60, 14.5F, -15})).error().what,
            "it is 9.5 cm from the origin (10 cm are needed): go further along the axis");
  ASSERT_TRUE(hold(guided, kOnX, at(kX)));
  EXPECT_EQ(hold(guided, kOnY, at({63, 45, -15})).error().what,
            "seen from the origin it is 4 degrees from the x axis (30 to 150 are needed): the "
            "three places are nearly on one line");
  EXPECT_EQ(hold(guided, kOnY, at({57, -35, -15})).error().what.substr(0, 39),
            "seen from the origin it is 176 degrees ");
  EXPECT_TRUE(hold(guided, kOnY, at(kY))) << "the same step again";
}

TEST(GuidedAlignment, SamplesWithAnErrorDoNotCount) {
  GuidedAlignment guided({});
  guided.begin(kOrigin);
  EXPECT_EQ(guided.end().error().what,
            "0 samples came (3 are needed): is this station's receiver plugged in?");
  EXPECT_EQ(guided.end().error().code, Errc::kTimeout);
  TrackerSample broken = at(kO);
  broken.error = 'a';
  for (int i = 0; i < 10; ++i) guided.add(broken);
  EXPECT_NE(guided.end().error().what.find("the unit reports error a"), std::string::npos)
      << guided.end().error().what;
}

}  // namespace
}  // namespace merlin::fastrak
