#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "nn/gesture/evaluation.h"
#include "nn/gesture/follower.h"
#include "tests/nn/moving.h"

namespace merlin::nn {
namespace {

constexpr float kFull = 2 * std::numbers::pi_v<float>;

// Returns a pose whose hand points at the wall and is rolled clockwise by `roll_rad`.
HandPose poseAt(double seconds, std::array<float, 3> position_m, float roll_rad = 0) {
  return {static_cast<std::int64_t>(seconds * 1e9),
          position_m,
          {std::cos(roll_rad / 2), 0, 0, -std::sin(roll_rad / 2)}};
}

float smooth(double share) {
  const double x = std::clamp(share, 0.0, 1.0);
  return static_cast<float>(x * x * x * (10 + x * (-15 + 6 * x)));
}

// Returns the poses of a hand that rests for half a second, moves for `seconds` as way() says, and
// rests again. The argument of way() is the share of `seconds` that has passed.
template <typename Way>
std::vector<HandPose> motion(double seconds, Way way, double rate_hz = 100) {
  std::vector<HandPose> poses;
  for (double t = 0; t < 1 + seconds; t += 1 / rate_hz)
    poses.push_back(way(t + 1, (t - 0.5) / seconds));
  return poses;
}

std::vector<HandPose> line(std::array<float, 3> way_m, float roll_rad = 0, double seconds = 0.4) {
  return motion(seconds, [=](double t, double share) {
    const float s = smooth(share);
    return poseAt(t, {way_m[0] * s, way_m[1] * s, way_m[2] * s}, roll_rad * s);
  });
}

std::vector<HandPose> circle(float turns) {
  return motion(0.9, [=](double t, double share) {
    const float angle = turns * kFull * static_cast<float>(std::clamp(share, 0.0, 1.0));
    return poseAt(t, {0.15F * std::sin(angle), 0.15F * std::cos(angle), 0});
  });
}

struct Found {
  StrokeFeatures features;
  std::int64_t first_ns, last_ns;
};

std::vector<Found> strokesIn(const std::vector<HandPose>& poses) {
  std::vector<Found> found;
  StrokeFinder finder;
  for (const HandPose& pose : poses) {
    const auto stroke = finder.update(pose);
    if (stroke.empty()) continue;
    const auto features = featuresOf(stroke, finder.calmBefore_m_s(), {});
    if (features) found.push_back({*features, stroke.front().at_ns, stroke.back().at_ns});
  }
  return found;
}

TEST(WallAxes, TurnTheTransmittersFrameIntoTheViewers) {
  const float position[3] = {1, 2, 3}, turn[4] = {0.5F, 0.1F, 0.2F, 0.3F};
  const HandPose pose = WallAxes().turned(7, position, turn);
  EXPECT_EQ(pose.at_ns, 7);
  EXPECT_EQ(pose.position_m, (std::array<float, 3>{-2, -3, 1}))
      << "x right is -y, y up is -z, z towards the person is x";
  EXPECT_EQ(pose.orientation_wxyz, (std::array<float, 4>{0.5F, -0.2F, -0.3F, 0.1F}));
  EXPECT_TRUE(WallAxes::of({-2, -3, 1}));
  EXPECT_TRUE(WallAxes::of({1, 2, 3}));
  EXPECT_FALSE(WallAxes::of({2, 1, 3})) << "left-handed";
  EXPECT_FALSE(WallAxes::of({-1, 2, 3}));
  EXPECT_FALSE(WallAxes::of({1, 1, 3}));
  EXPECT_FALSE(WallAxes::of({1, 2, 4}));
  EXPECT_FALSE(WallAxes::of({0, 2, 3}));
}

TEST(Strokes, ASwipeIsOneStrokeWithItsDirection) {
  const auto found = strokesIn(line({0.4F, 0, 0}));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].features[0], 0.99F) << "right";
  EXPECT_NEAR(found[0].features[1], 0, 0.02);
  EXPECT_NEAR(found[0].features[kRoll], 0, 0.02);
  EXPECT_NEAR(std::exp(found[0].features[kLogSpeed]), 1.875 * 0.4 / 0.4, 0.15);
  EXPECT_NEAR(static_cast<double>(found[0].first_ns) * 1e-9, 1.5, 0.15);
  EXPECT_NEAR(static_cast<double>(found[0].last_ns) * 1e-9, 1.9, 0.1);
  EXPECT_LT(strokesIn(line({-0.4F, 0, 0}))[0].features[0], -0.99F);
  EXPECT_GT(strokesIn(line({0, 0.4F, 0}))[0].features[1], 0.99F);
  EXPECT_GT(strokesIn(line({0, 0, 0.4F}))[0].features[2], 0.99F);
}

TEST(Strokes, ATwistIsRollAndClockwiseIsPositive) {
  const auto found = strokesIn(line({0, 0, 0}, 1.3F));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].features[kRoll], 0.99F);
  EXPECT_LT(strokesIn(line({0, 0, 0}, -1.3F))[0].features[kRoll], -0.99F);
}

TEST(Strokes, ACircleTurnsOnceWhereverItBegins) {
  const auto found = strokesIn(circle(1));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].features[4], 0.96F, 0.05) << "turning, of 24 points";
  EXPECT_GT(found[0].features[5], 0.9F) << "area";
  const auto other = strokesIn(circle(-1));
  ASSERT_EQ(other.size(), 1u);
  EXPECT_NEAR(other[0].features[4], -0.96F, 0.05);
  EXPECT_LT(other[0].features[5], -0.9F);
}

TEST(Strokes, ThereAndBackAreTwo) {
  const auto found = strokesIn(motion(0.8, [](double t, double share) {
    const float s = share < 0.5 ? smooth(2 * share) : 1 - smooth(2 * share - 1);
    return poseAt(t, {0.4F * s, 0, 0});
  }));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GT(found[0].features[0], 0.95F);
  EXPECT_LT(found[1].features[0], -0.95F);
}

TEST(Strokes, ARestIsNoneAndAGapBeginsAnew) {
  EXPECT_TRUE(strokesIn(line({0, 0, 0})).empty());
  std::vector<HandPose> poses = line({0.4F, 0, 0});
  std::erase_if(
      poses, [](const HandPose& p) { return p.at_ns > 1'650'000'000 && p.at_ns < 1'950'000'000; });
  EXPECT_TRUE(strokesIn(poses).empty()) << "its middle was not seen";
}

TEST(Strokes, AMotionWithoutEndIsNone) {
  StrokeFinder finder;
  for (int n = 0; n < 2000; ++n) {
    const auto t = static_cast<float>(n) * 0.01F;
    EXPECT_TRUE(finder.update(poseAt(n * 0.01, {std::sin(t), std::cos(t), 0})).empty()) << n;
  }
  int strokes = 0;  // the motion ends after 20 s
  for (int n = 2000; n < 2100; ++n)
    strokes += finder.update(poseAt(n * 0.01, {0.91F, 0.41F, 0})).empty() ? 0 : 1;
  EXPECT_EQ(strokes, 0);
}

TEST(Strokes, WhatIsNotFiniteIsPassedOver) {
  std::vector<HandPose> poses = line({0.4F, 0, 0});
  const auto before = strokesIn(poses);
  HandPose bad = poses[60];
  bad.at_ns += 1'000'000;
  bad.position_m[1] = std::nanf("");
  poses.insert(poses.begin() + 61, bad);
  bad.position_m[1] = 0;
  bad.orientation_wxyz[2] = INFINITY;
  poses.insert(poses.begin() + 61, bad);
  const auto after = strokesIn(poses);
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after[0].features, before[0].features);
}

TEST(UsualPaceTest, OnePersonsHasteIsAnothersPace) {
  UsualPace pace;
  const float before = pace.hasteOf(-0.7F, 0.6F);
  for (int n = 0; n < 50; ++n) pace.learn(-0.7F, 0.4F, 0);
  EXPECT_LT(pace.hasteOf(-0.7F, 0.6F), before - 0.1F);
  UsualPace turned;
  for (int n = 0; n < 50; ++n) turned.learn(-0.7F, 0.4F, 0.9F);
  for (int n = 0; n < 50; ++n) turned.learn(-2.5F, 0.4F, 0);
  EXPECT_EQ(turned.hasteOf(-0.7F, 0.6F), before) << "turns and short strokes say nothing";
  for (int n = 0; n < 500; ++n) pace.learn(-0.7F, 9, 0);
  EXPECT_NEAR(pace.hasteOf(-0.7F, 0.6F), before - 0.35F, 1e-4) << "nobody is farther from others";
}

TEST(DiscriminantTest, FindsAQuadric) {
  std::vector<DiscriminantExample> examples;
  Random random(1);
  for (int n = 0; n < 800; ++n) {
    DiscriminantExample e;
    for (float& v : e.whitened) v = static_cast<float>(random.normal());
    e.meant = e.whitened[0] * e.whitened[0] + e.whitened[1] > 1;
    examples.push_back(e);
  }
  const Discriminant found = fitDiscriminant(examples, 0.1);
  const auto right = std::count_if(examples.begin(), examples.end(), [&](const auto& e) {
    return (oddsOf(found, e.whitened) > 0) == e.meant;
  });
  EXPECT_GT(right, 780);
}

// People 1 to 12 train the model, and people 801 to 806 test it. The numbers are small so that the
// test is fast; the benchmark has the figures of the shipped file.
const GestureModel& trained() {
  static const GestureModel model = [] {
    PathRecording recording = test::gesturesOf(1, 12, 4, 1);
    test::join(recording, test::ordinaryOf(1, 12, 120, 2));
    std::size_t lost = 0;
    const auto result = trainGestures(strokesOf(recording, 0.8, lost), {});
    EXPECT_TRUE(result) << result.error().what;
    EXPECT_LT(lost, 10u);
    return result ? *result : GestureModel{};
  }();
  return model;
}

std::vector<Gesture> gesturesIn(const std::vector<HandPose>& poses, GestureFollower& follower) {
  std::vector<Gesture> gestures;
  for (const HandPose& pose : poses) {
    if (const auto gesture = follower.update(pose)) gestures.push_back(*gesture);
  }
  return gestures;
}

TEST(GestureFollowerTest, NamesTheReadyGestures) {
  ASSERT_EQ(trained().gestures.size(), 10u);
  const auto named = [](const std::vector<HandPose>& poses) {
    GestureFollower follower(trained());
    const auto gestures = gesturesIn(poses, follower);
    return gestures.size() == 1 ? std::string(gestures[0].name) : "?";
  };
  EXPECT_EQ(named(line({0.48F, 0, 0}, 0, 0.38)), "swipe_right");
  EXPECT_EQ(named(line({-0.48F, 0, 0}, 0, 0.38)), "swipe_left");
  EXPECT_EQ(named(line({0, 0.4F, 0}, 0, 0.37)), "swipe_up");
  EXPECT_EQ(named(line({0, -0.4F, 0}, 0, 0.37)), "swipe_down");
  EXPECT_EQ(named(line({0, 0.02F, -0.34F}, 0, 0.37)), "push");
  EXPECT_EQ(named(line({0, -0.02F, 0.34F}, 0, 0.37)), "pull");
  EXPECT_EQ(named(line({0.01F, 0, 0}, 1.35F, 0.36)), "twist_right");
  EXPECT_EQ(named(line({-0.01F, 0, 0}, -1.35F, 0.36)), "twist_left");
  EXPECT_EQ(named(circle(1.1F)), "circle_clockwise");
  EXPECT_EQ(named(circle(-1.1F)), "circle_counterclockwise");
}

TEST(GestureFollowerTest, SaysWhenTheGestureWasAndHowCertainItIs) {
  GestureFollower follower(trained());
  const auto gestures = gesturesIn(line({0.48F, 0, 0}, 0, 0.38), follower);
  ASSERT_EQ(gestures.size(), 1u);
  EXPECT_EQ(follower.name(gestures[0].index), "swipe_right");
  EXPECT_NEAR(static_cast<double>(gestures[0].began_ns) * 1e-9, 1.5, 0.15);
  EXPECT_NEAR(static_cast<double>(gestures[0].ended_ns) * 1e-9, 1.88, 0.1);
  EXPECT_GT(gestures[0].certainty, 0.2F);
  EXPECT_LE(gestures[0].certainty, 1.0F);
}

TEST(GestureFollowerTest, AnUnhurriedReachIsNoGesture) {
  GestureFollower follower(trained());
  EXPECT_TRUE(gesturesIn(line({0.35F, 0, 0}, 0, 1.2), follower).empty());
}

TEST(GestureFollowerTest, TheWayBackIsNoGesture) {
  // The names are copied, since they live only as long as the follower.
  const auto thereAndBack = [](double rest_s) {
    GestureFollower follower(trained());
    std::vector<HandPose> poses = line({0.48F, 0, 0}, 0, 0.38);
    const auto back = line({-0.48F, 0, 0}, 0, 0.38);
    const HandPose last = poses.back();
    for (const HandPose& p : back) {
      HandPose moved = p;
      moved.position_m[0] += last.position_m[0];
      moved.at_ns += last.at_ns - back.front().at_ns + 10'000'000 +
                     static_cast<std::int64_t>((rest_s - 1) * 1e9);
      if (moved.at_ns > poses.back().at_ns) poses.push_back(moved);
    }
    std::vector<std::string> names;
    for (const Gesture& gesture : gesturesIn(poses, follower)) names.emplace_back(gesture.name);
    return names;
  };
  ASSERT_EQ(thereAndBack(0.4).size(), 1u);
  EXPECT_EQ(thereAndBack(0.4)[0], "swipe_right");
  const auto apart = thereAndBack(1.0);
  ASSERT_EQ(apart.size(), 2u) << "meant, since it comes later";
  EXPECT_EQ(apart[1], "swipe_left");
}

TEST(GestureTraining, IsRightOnPeopleItHasNotSeenAndTheSameEachTime) {
  GestureEvaluation e;
  evaluateGestures(test::gesturesOf(801, 6, 3, 5), trained(), e);
  evaluateGestures(test::ordinaryOf(801, 6, 200, 5), trained(), e);
  EXPECT_EQ(e.all.takes, 180u);
  EXPECT_GT(e.all.rate(), 0.85);
  EXPECT_EQ(e.all.takes, e.all.right + e.all.missed + e.all.wrong + e.all.repeated);
  EXPECT_LT(e.inventedPerTenMinutes(), 20);
  std::size_t lost = 0;
  const auto strokes = strokesOf(test::gesturesOf(1, 3, 4, 1), 0.8, lost);
  const auto one = trainGestures(strokes, {}), again = trainGestures(strokes, {});
  ASSERT_TRUE(one && again);
  for (std::size_t k = 0; k < one->gestures.size(); ++k) {
    EXPECT_EQ(one->gestures[k].strokes.whitening, again->gestures[k].strokes.whitening);
    EXPECT_EQ(one->gestures[k].limit, again->gestures[k].limit);
  }
}

TEST(GestureTraining, SaysWhatItCannotTrainOn) {
  const auto wrong = [](std::vector<LabelledStroke> strokes) {
    const auto result = trainGestures(strokes, {});
    return result ? std::string() : result.error().what;
  };
  EXPECT_NE(wrong({}).find("no gesture in it: in no take"), std::string::npos);
  EXPECT_NE(wrong({{"wave", {}}, {"wave", {}}}).find("2 strokes of \"wave\"; needed: 3"),
            std::string::npos);
  EXPECT_NE(wrong({{"two words", {}}}).find("gesture \"two words\""), std::string::npos);
}

TEST(PathRecordingTest, ATakeOfAGestureNeedsAStroke) {
  const auto faultOf = [](const std::vector<HandPose>& poses) {
    PathRecording take;
    for (const HandPose& p : poses) take.poses.push_back({take.labelled("wave"), p});
    const auto checked = checkTake(take);
    return checked ? std::string() : checked.error().what;
  };
  const auto fault = [](const char* moved) {
    return fmt::format(
        "the hand made no stroke: it moved {}, its turn included; make the gesture "
        "once, faster than 0.25 m/s, and begin and end it within the take",
        moved);
  };
  EXPECT_EQ(faultOf(line({0.3F, 0, 0})), "");
  EXPECT_EQ(faultOf(line({0, 0, 0}, 1.5F)), "") << "a twist";
  EXPECT_EQ(faultOf(line({0, 0, 0})), fault("0 cm, at most 0.00 m/s"));
  EXPECT_EQ(faultOf(line({0.3F, 0, 0}, 0, 3)), fault("30 cm, at most 0.19 m/s"));
  std::vector<HandPose> cut = line({0.3F, 0, 0});
  cut.resize(70);  // the hand still moves at the end of the recording
  EXPECT_EQ(faultOf(cut), fault("14 cm, at most 1.25 m/s"));
}

TEST(PathRecordingTest, ATakeHasOneStrokeAndTheWayBackIsLeftOut) {
  PathRecording recording;
  const auto add = [&](const std::vector<HandPose>& poses, double later_s, const char* label) {
    for (HandPose p : poses) {
      p.at_ns += static_cast<std::int64_t>(later_s * 1e9);
      recording.poses.push_back({recording.labelled(label), p});
    }
  };
  add(line({0.4F, 0, 0}), 0, "wave");
  add(line({0.3F, 0, 0}), 1.5, "none");
  add(line({0.2F, 0, 0}), 6, "none");
  ASSERT_EQ(sessionsOf(recording).size(), 2u) << "half a second without a pose";
  std::size_t lost = 9;
  auto strokes = strokesOf(recording, 0.8, lost);
  EXPECT_EQ(lost, 0u);
  ASSERT_EQ(strokes.size(), 2u);
  EXPECT_EQ(strokes[0].gesture, "wave");
  EXPECT_EQ(strokes[1].gesture, "none");
  strokes = strokesOf(recording, 0.3, lost);
  EXPECT_EQ(strokes.size(), 3u);
}

}  // namespace
}  // namespace merlin::nn
