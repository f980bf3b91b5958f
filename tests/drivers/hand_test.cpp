// The hand with synthetic motion: named joints, the smoothed pose, and the prediction of the pose
// for another time.
#include "drivers/hand/hand.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin::hand {
namespace {

TrackerSample at(double t_s, double x_m, double yaw_rad) {
  TrackerSample s{};
  s.received_ns = static_cast<std::int64_t>(t_s * 1e9) + 1'000'000'000;
  s.counter = static_cast<std::uint32_t>(t_s * 120 + 0.5);
  s.station = 1;
  s.position_m[0] = static_cast<float>(x_m);
  s.orientation_wxyz[0] = static_cast<float>(std::cos(yaw_rad / 2));
  s.orientation_wxyz[3] = static_cast<float>(std::sin(yaw_rad / 2));
  s.error = ' ';
  return s;
}

double yawOf(const float* q) { return 2 * std::atan2(double{q[3]}, double{q[0]}); }

TEST(Hand, NamesItsJoints) {
  EXPECT_EQ(jointNamed("index_mcp"), 4u);
  EXPECT_EQ(jointNamed("wrist_yaw"), 22u);
  EXPECT_FALSE(jointNamed("nose"));
}

TEST(Hand, TakesTheGlovesAnglesWhileTheyAreFresh) {
  Hand hand({});
  GloveSample glove{};
  glove.received_ns = 1'000'000'000;
  glove.angle_rad[4] = 1.5F;
  HandSample h = hand.update(at(0.1, 0, 0), glove);
  EXPECT_EQ(h.flags, HandSample::kJoints);
  EXPECT_EQ(h.joint_rad[4], 1.5F);
  EXPECT_EQ(h.glove_ns, 1'000'000'000);
  h = hand.update(at(0.6, 0, 0), glove);
  EXPECT_EQ(h.flags, 0u) << "half a second old";
  EXPECT_EQ(hand.update(at(0.7, 0, 0), std::nullopt).flags, 0u);
}

// At rest, the filter leaves less than a third of the tracker's noise (0.76 mm RMS); the sample
// states the filter's delay.
TEST(Hand, AtRestTremblesAThirdAsMuch) {
  Hand hand({});
  Random random(1);
  double square = 0, delay = 0;
  int n = 0;
  for (int i = 0; i < 2400; ++i) {
    const HandSample h = hand.update(at(i / 120.0, 0.00076 * random.normal(), 0), std::nullopt);
    if (i < 240) continue;
    square += double{h.position_m[0]} * double{h.position_m[0]};
    delay += double{h.delay_s};
    ++n;
  }
  EXPECT_LT(std::sqrt(square / n), 0.00076 / 3);
  EXPECT_LT(delay / n, 0.053);  // the delay of a low-pass filter of 3 Hz: 1 / (2 pi 3 Hz)
  EXPECT_GT(delay / n, 0.020);
}

TEST(Hand, MovingTrailsByTheDelayThatItTells) {
  Hand hand({});
  HandSample h{};
  constexpr double kSpeed = 0.5;
  for (int i = 0; i < 240; ++i) h = hand.update(at(i / 120.0, kSpeed * i / 120.0, 0), std::nullopt);
  const double behind_m = kSpeed * 239 / 120.0 - double{h.position_m[0]};
  EXPECT_NEAR(h.velocity_m_s[0], kSpeed, 0.01);
  EXPECT_LT(h.delay_s, 0.011F);
  EXPECT_NEAR(behind_m / kSpeed, double{h.delay_s}, 0.004);
}

TEST(Hand, WithoutSmoothingIsTheTracker) {
  HandSettings settings;
  settings.cutoff_hz = settings.cutoff_per_m_s = 0;
  Hand hand(settings);
  for (int i = 0; i < 50; ++i) {
    const TrackerSample t = at(i / 120.0, std::sin(i * 0.1), 0.3 * std::sin(i * 0.2));
    const HandSample h = hand.update(t, std::nullopt);
    EXPECT_NEAR(h.position_m[0], t.position_m[0], 1e-6F);
    EXPECT_NEAR(yawOf(h.orientation_wxyz), yawOf(t.orientation_wxyz), 1e-5);
    EXPECT_EQ(h.delay_s, 0.0F);
  }
}

// A hand that moves by +-0.2 m at 0.5 Hz and turns, shown 30 ms after it was measured: the error
// with prediction is less than half of that without.
TEST(Hand, PredictionToTheDisplayTimeIsWorthIt) {
  Hand hand({});
  Random random(3);
  constexpr double kAhead = 0.03;
  const auto place = [](double t) { return 0.2 * std::sin(std::numbers::pi * t); };
  const auto yaw = [](double t) { return 0.7 * std::sin(std::numbers::pi * t + 1); };
  double plain = 0, predicted = 0, plain_yaw = 0, predicted_yaw = 0;
  for (int i = 0; i < 1200; ++i) {
    const double t = i / 120.0, then = t + kAhead;
    const TrackerSample seen =
        at(t, place(t) + 0.00076 * random.normal(), yaw(t) + 0.0026 * random.normal());
    const HandSample h = hand.update(seen, std::nullopt);
    if (i < 120) continue;
    const Pose pose = poseAt(h, fromNanoseconds(h.received_ns) + fromSeconds(kAhead));
    plain += std::pow(double{seen.position_m[0]} - place(then), 2);
    predicted += std::pow(double{pose.position_m[0]} - place(then), 2);
    plain_yaw += std::pow(yawOf(seen.orientation_wxyz) - yaw(then), 2);
    predicted_yaw += std::pow(yawOf(pose.orientation_wxyz.data()) - yaw(then), 2);
  }
  EXPECT_LT(std::sqrt(predicted), 0.5 * std::sqrt(plain));
  EXPECT_LT(std::sqrt(predicted_yaw), 0.5 * std::sqrt(plain_yaw));
}

TEST(Hand, PredictsNoFurtherThanATenthOfASecond) {
  Hand hand({});
  HandSample h{};
  for (int i = 0; i < 240; ++i) h = hand.update(at(i / 120.0, 1.0 * i / 120.0, 0), std::nullopt);
  const Pose pose = poseAt(h, fromNanoseconds(h.received_ns) + std::chrono::seconds(5));
  EXPECT_NEAR(pose.position_m[0] - h.position_m[0], 0.1, 0.005);
}

TEST(Hand, IsTakenUpAnewAfterAGap) {
  Hand hand({});
  for (int i = 0; i < 120; ++i) hand.update(at(i / 120.0, 1.0 * i / 120.0, 0), std::nullopt);
  const HandSample h = hand.update(at(3, 0.2, 0.4), std::nullopt);
  EXPECT_FLOAT_EQ(h.position_m[0], 0.2F);
  EXPECT_EQ(h.velocity_m_s[0], 0.0F);
}

}  // namespace
}  // namespace merlin::hand
