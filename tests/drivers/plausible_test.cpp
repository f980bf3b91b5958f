#include "drivers/port/plausible.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace merlin {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNever[] = {kNan, kInfinite, -kInfinite, 1e30F, -3e38F};

TrackerSample tracker() {
  TrackerSample s{};
  s.station = 1;
  s.orientation_wxyz[0] = 1;
  s.error = ' ';
  return s;
}

HandSample hand() {
  HandSample s{};
  s.orientation_wxyz[0] = 1;
  return s;
}

// Expects that `good` is plausible, and that it is implausible when any element of `numbers` is one
// of kNever.
template <typename Sample, std::size_t N>
void expectBounded(const Sample& good, float (Sample::*numbers)[N]) {
  ASSERT_TRUE(plausible(good));
  for (std::size_t i = 0; i < N; ++i) {
    for (const float bad : kNever) {
      Sample s = good;
      (s.*numbers)[i] = bad;
      EXPECT_FALSE(plausible(s)) << "number " << i << ": " << bad;
    }
  }
}

TEST(Plausible, NoNumberOfAnySampleIsNanInfiniteOrHuge) {
  expectBounded(GloveSample{}, &GloveSample::angle_rad);
  expectBounded(tracker(), &TrackerSample::position_m);
  expectBounded(tracker(), &TrackerSample::orientation_wxyz);
  expectBounded(BallSample{}, &BallSample::translation);
  expectBounded(BallSample{}, &BallSample::rotation);
  expectBounded(PostureSample{}, &PostureSample::activation);
  expectBounded(hand(), &HandSample::joint_rad);
  expectBounded(hand(), &HandSample::position_m);
  expectBounded(hand(), &HandSample::orientation_wxyz);
  expectBounded(hand(), &HandSample::velocity_m_s);
  expectBounded(hand(), &HandSample::turn_rad_s);
}

TEST(Plausible, ATrackersPlaceIsWithinItsReachAndItsOriginsAndItsTurnIsOne) {
  TrackerSample s = tracker();
  s.position_m[2] = -25;
  EXPECT_TRUE(plausible(s));
  s.position_m[2] = -25.1F;
  EXPECT_FALSE(plausible(s));
  s = tracker();
  s.orientation_wxyz[0] = 0;
  EXPECT_FALSE(plausible(s));
  s.orientation_wxyz[3] = 1.019F;
  EXPECT_TRUE(plausible(s));
  s.orientation_wxyz[3] = 1.03F;
  EXPECT_FALSE(plausible(s));
}

TEST(Plausible, CodesAreThoseThatThereAre) {
  TrackerSample t = tracker();
  for (const std::uint32_t station : {0u, 5u, 0xFFFFFFFFu}) {
    t.station = station;
    EXPECT_FALSE(plausible(t)) << station;
  }
  t = tracker();
  t.error = '\n';
  EXPECT_FALSE(plausible(t));
  t = tracker();
  t.stylus = 2;
  EXPECT_FALSE(plausible(t));
  BallSample ball{};
  ball.buttons = 0xFFF;
  EXPECT_TRUE(plausible(ball));
  ball.buttons = 0x1000;
  EXPECT_FALSE(plausible(ball));
  GloveSample glove{};
  glove.sensors = 24;
  EXPECT_FALSE(plausible(glove));
  glove.sensors = 22;
  glove.flags = 8;
  EXPECT_FALSE(plausible(glove));
  PostureSample posture{};
  posture.code = 31;
  EXPECT_TRUE(plausible(posture));
  posture.code = 32;
  EXPECT_FALSE(plausible(posture));
  posture = {};
  std::fill(std::begin(posture.name), std::end(posture.name), 'x');
  EXPECT_FALSE(plausible(posture));
}

}  // namespace
}  // namespace merlin
