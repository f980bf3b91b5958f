// The ball, the bindings, and what counts as motion.
#include "render/scene/scene.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/render/scene_play.h"

namespace merlin::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using test::expectAt;
using test::ScenePlay;
using test::turnedBy;

const Vector3f kX = Vector3f::UnitX(), kY = Vector3f::UnitY(), kZ = Vector3f::UnitZ();
const Vector3f kStart(0, 0, -2);  // the default position

TEST(Scene, StartsWhereTheSettingsSay) {
  expectAt(ScenePlay(), kStart);
  ScenePlay play({.model_distance_m = 5, .model_yaw_deg = 90, .model_pitch_deg = 30});
  expectAt(play, {0, 0, -5}, turnedBy(90, kY) * turnedBy(30, kX));
  const scene::Scene unused = *scene::Scene::make({.model_distance_m = 5});
  EXPECT_EQ(unused.view().T_eye_model.translation(), Vector3f(0, 0, -5));
  EXPECT_TRUE(unused.view().moving);
}

TEST(SceneBall, MovesTheModelBySpeedTimesTimeOnEachAxis) {
  ScenePlay play({.ball_speed_m_s = {1, 2, 4}});
  play.push({0.5F, -0.25F, 1});
  play.update(100);
  expectAt(play, kStart + Vector3f(0.05F, -0.05F, 0.4F));
  play.update(20);
  expectAt(play, kStart + Vector3f(0.06F, -0.06F, 0.48F));
}

TEST(SceneBall, TurnsTheModelAboutItsOwnCentreAndTheViewersAxes) {
  const scene::SceneSettings settings = {.ball_turn_deg_s = {100, 200, 300}};
  const Vector3f axes[] = {kX, kY, kZ};
  for (int k = 0; k < 3; ++k) {
    ScenePlay play(settings);
    play.push(Vector3f::Zero(), 0.5F * axes[k]);
    play.update(100);
    expectAt(play, kStart, turnedBy(5.0F * static_cast<float>(k + 1), axes[k]));
  }
  ScenePlay play(settings);
  play.push(Vector3f::Zero(), kX);
  for (int i = 0; i < 9; ++i) play.update(100);  // 90 degrees
  play.push(Vector3f::Zero(), kY);
  // 60 degrees about the viewer's y axis, not the model's.
  for (int i = 0; i < 3; ++i) play.update(100);
  expectAt(play, kStart, turnedBy(60, kY) * turnedBy(90, kX));
}

TEST(SceneStep, IsAppliedOnceWhateverTheFrameTakes) {
  for (const int frame_ms : {1, 500}) {
    ScenePlay play({.ball_speed_m_s = {9, 9, 9}, .ball_turn_deg_s = {9, 9, 9}});
    play.rest();
    play.input.step = {{0.5F, -0.25F, 1}, Vector3f(0, 30 * test::kRadian, 0)};
    EXPECT_TRUE(play.update(frame_ms).moving);
    expectAt(play, kStart + Vector3f(0.5F, -0.25F, 1), turnedBy(30, kY));
    play.update(frame_ms);
    expectAt(play, kStart + Vector3f(0.5F, -0.25F, 1), turnedBy(30, kY));
  }
}

// With this, a drag in a window, in a VNC client or on the page also moves a picture.
TEST(SceneStep, ThatWouldTurnAPlaneMovesItAsAFingerDoes) {
  ScenePlay play({.model_radius_m = 2});
  play.scene.setNavigation(content::Navigation::kPlane);
  play.rest();
  play.input.step = {{0, 0.5F, 0}, Vector3f(-18, 36, 90) * test::kRadian};
  EXPECT_TRUE(play.update(10).moving);
  expectAt(play, kStart + Vector3f(0.6F, 0.8F, 0));
  play.scene.reset();
  play.input.touch = {.fingers = 1, .right = 0.2F, .up = 0.1F};
  play.update(10);
  expectAt(play, kStart + Vector3f(0.6F, 0.3F, 0));
}

TEST(SceneStep, MovesTheViewerInModeFly) {
  ScenePlay play;
  play.input.next_mode = 1;
  play.input.step = {{0, 0, -0.5F}, Vector3f::Zero()};
  play.update(10);
  expectAt(play, kStart + Vector3f(0, 0, 0.5F));
}

TEST(SceneHeld, MovesAsABallThatIsPushedHalfWayWhicheverSignItsSpeedHas) {
  ScenePlay play({.ball_speed_m_s = {-1, 2, 4}, .ball_turn_deg_s = {100, -200, 300}});
  play.input.held = {.right = 1, .up = -1};
  EXPECT_TRUE(play.update(100).moving);
  expectAt(play, kStart + Vector3f(0.05F, -0.1F, 0));
  play.input.held = {.right = -1, .up = 1};
  play.update(100);
  play.input.held = {.turn_right = 1};
  play.update(100);
  expectAt(play, kStart, turnedBy(10, kY));
  play.input.held = {.turn_right = -1};
  play.update(100);
  play.input.held = {.turn_up = 1};
  play.update(100);
  expectAt(play, kStart, turnedBy(-5, kX));
  play.input.held = {.turn_up = -1};
  play.update(100);
  play.input.held = {.roll_right = 1};
  play.update(100);
  expectAt(play, kStart, turnedBy(-15, kZ));
}

TEST(SceneHeld, ZoomHalvesAndDoublesTheDistanceInASecond) {
  for (const bool fly : {false, true}) {
    ScenePlay play;
    if (fly) play.scene.nextMode();
    play.input.held = {.nearer = 1};
    for (int i = 0; i < 10; ++i) play.update(100);
    expectAt(play, kStart / 2);
    play.input.held = {.nearer = -1};
    for (int i = 0; i < 20; ++i) play.update(100);
    expectAt(play, kStart * 2);
  }
}

// In the mode fly, "right" turns the viewer to the right, so the model moves to the left.
TEST(SceneHeld, TurnsTheViewInModeFlyAndInAPanorama) {
  ScenePlay fly({.ball_turn_deg_s = {100, 100, 100}});
  fly.scene.nextMode();
  fly.input.held = {.turn_right = 1, .turn_up = 1};
  for (int i = 0; i < 4; ++i) fly.update(100);
  const Vector3f seen = fly.scene.view().T_eye_model.translation();
  EXPECT_LT(seen.x(), -0.1F);
  EXPECT_LT(seen.y(), -0.1F);
  ScenePlay panorama({.ball_turn_deg_s = {100, 100, 100}});
  panorama.scene.setNavigation(content::Navigation::kPanorama);
  const auto before = panorama.scene.view().T_eye_model;
  panorama.input.held = {.turn_right = 1, .turn_up = 1};
  for (int i = 0; i < 4; ++i) panorama.update(100);
  const Vector3f was_ahead =
      panorama.scene.view().T_eye_model.linear() * before.linear().transpose() * -kZ;
  EXPECT_LT(was_ahead.x(), -0.1F);
  EXPECT_LT(was_ahead.y(), -0.1F);
}

TEST(SceneBall, TurnsAboutTheAxisOfTheWholeTwist) {
  ScenePlay play({.ball_turn_deg_s = {90, 90, 180}});
  play.push(Vector3f::Zero(), {1, 0, 0.5F});
  play.update(100);
  expectAt(play, kStart, turnedBy(9 * std::sqrt(2.0F), {1, 0, 1}));
}

TEST(SceneBall, MovesNothingWhileTimeStandsStill) {
  ScenePlay play;
  play.push({1, 1, 1}, {1, 1, 1});
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(play.update(0).moving);
  expectAt(play, kStart);
}

TEST(SceneBall, AFrameThatTookLongMovesAsOneOfATenthOfASecond) {
  ScenePlay play;
  play.push(kX);
  play.update(60'000);
  expectAt(play, kStart + 0.1F * kX);
}

TEST(SceneFly, TheBallMovesTheViewer) {
  ScenePlay play;
  play.scene.nextMode();
  play.push(-kZ);  // away from the viewer
  EXPECT_EQ(play.update(100).mode, scene::BallMode::kFly);
  expectAt(play, {0, 0, -1.9F});
  play.push(kX);
  play.update(100);
  expectAt(play, {-0.1F, 0, -1.9F});
}

// The viewer turns by 90 degrees to the left: the model is then on the right, and "ahead" is the
// former left.
TEST(SceneFly, TheViewerTurnsAboutTheEyeAndFliesAhead) {
  ScenePlay play;
  play.scene.nextMode();
  play.push(Vector3f::Zero(), kY);
  for (int i = 0; i < 10; ++i) play.update(100);
  expectAt(play, {2, 0, 0}, turnedBy(-90, kY));
  play.push(-kZ);
  play.update(100);
  expectAt(play, {2, 0, 0.1F}, turnedBy(-90, kY));
  play.scene.nextMode();  // moves the model again, along the viewer's axes
  play.push(kX);
  play.update(100);
  expectAt(play, {2.1F, 0, 0.1F}, turnedBy(-90, kY));
  play.push(Vector3f::Zero(), kX);
  for (int i = 0; i < 10; ++i) play.update(100);
  expectAt(play, {2.1F, 0, 0.1F}, turnedBy(90, kX) * turnedBy(-90, kY));
}

TEST(SceneReset, BringsModelAndViewerBackAndKeepsTheMode) {
  ScenePlay play;
  play.push({1, 1, 1}, {1, 0, 1});
  play.update(100);
  play.scene.nextMode();
  play.update(100);
  play.push(Vector3f::Zero());
  play.rest();
  play.input.reset_view = 1;
  const scene::SceneView view = play.update(20);
  expectAt(play, kStart);
  EXPECT_TRUE(view.moving);
  EXPECT_EQ(view.mode, scene::BallMode::kFly);
  EXPECT_FALSE(play.update(150).moving);
  play.scene.reset();
  EXPECT_TRUE(play.scene.view().moving);
  EXPECT_EQ(play.scene.view().mode, scene::BallMode::kFly);
  EXPECT_TRUE(play.update(200).moving) << "by command, at 5 Hz";
}

TEST(SceneActions, AreDoneAsOftenAsTheyWereAskedFor) {
  ScenePlay play;
  play.input.next_mode = 1;
  EXPECT_EQ(play.update(20).mode, scene::BallMode::kFly);
  EXPECT_EQ(play.update(20).mode, scene::BallMode::kFly) << "once";
  play.input.next_mode = 2;
  EXPECT_EQ(play.update(20).mode, scene::BallMode::kFly) << "there and back";
  play.input.next_mode = 3;
  EXPECT_EQ(play.update(20).mode, scene::BallMode::kObject);
}

TEST(SceneActions, FlyMovesTheViewerAsFastAsTheHandIsAway) {
  scene::SceneSettings settings;
  settings.tracker_axes = {1, 2, 3};
  settings.fly_gain = 4;
  ScenePlay play(settings);
  play.input.fly = true;
  play.holdHand({0, 0, 0});
  play.update(20);
  const Vector3f before = play.position();
  play.update(20);
  EXPECT_EQ(play.position(), before) << "where it began: no speed";
  play.holdHand({0, 0, -0.1F});
  for (int i = 0; i < 10; ++i) play.update(50);  // 0.4 m/s for 0.5 s
  EXPECT_NEAR(play.position().z() - before.z(), 0.2F, 1e-4F);
  play.input.fly = false;
  play.update(50);
  const Vector3f left = play.position();
  play.update(50);
  EXPECT_EQ(play.position(), left);
}

TEST(SceneMotion, EndsAWhileAfterTheLastInput) {
  ScenePlay play({.still_after_s = 0.15});
  EXPECT_TRUE(play.update(149).moving) << "the start counts";
  EXPECT_FALSE(play.update(1).moving);
  play.push({1e-6F, 0, 0});
  EXPECT_TRUE(play.update(20).moving) << "the driver has taken the noise away";
  play.push(Vector3f::Zero());
  EXPECT_TRUE(play.update(149).moving);
  EXPECT_FALSE(play.update(1).moving);
  play.push(Vector3f::Zero(), {0, 0, -1e-6F});
  EXPECT_TRUE(play.update(20).moving);
  play.input.ball.reset();
  EXPECT_FALSE(play.update(150).moving);
}

TEST(SceneSettings, AnAxisMapThatIsNoTurnIsRefused) {
  constexpr int kLeast = std::numeric_limits<int>::min();
  for (const std::array<int, 3>& axes : {std::array{0, 2, 3},
                                         {1, 1, 3},
                                         {1, -1, 2},
                                         {1, 2, 4},
                                         {-4, 2, 3},
                                         {kLeast, 2, 3},
                                         {1, 2, -3},
                                         {2, 1, 3},
                                         {-1, -2, -3}}) {  // the last one is a reflection
    const auto scene = scene::Scene::make({.tracker_axes = axes});
    ASSERT_FALSE(scene) << axes[0];
    EXPECT_EQ(scene.error().code, Errc::kInvalidArgument);
    EXPECT_TRUE(scene.error().what.starts_with("tracker_axes " + std::to_string(axes[0]) + ", "));
  }
  int turns = 0;
  for (int code = 0; code < 343; ++code) {
    turns += scene::Scene::make({.tracker_axes = {code % 7 - 3, code / 7 % 7 - 3, code / 49 - 3}})
                 ? 1
                 : 0;
  }
  EXPECT_EQ(turns, 24) << "as many as a cube has";
}

TEST(SceneBounds, NothingThatIsPushedForEverLeavesTheWorld) {
  scene::SceneSettings settings;
  settings.ball_speed_m_s = {100, 100, 100};
  ScenePlay play(settings);
  play.push({1, 1, -1}, {1, 1, 1});
  for (int i = 0; i < 3000; ++i) play.update(100);
  EXPECT_NEAR(play.position().norm(), render::scene::Scene::kWorld_m, 1);
  play.scene.nextMode();
  for (int i = 0; i < 3000; ++i) play.update(100);
  EXPECT_LE(play.position().norm(), 2.001F * render::scene::Scene::kWorld_m);
  play.scene.reset();
  play.push({0, 0, 0});
  play.update(100);
  expectAt(play, {0, 0, -2});
}

TEST(SceneBounds, ARotationStaysOne) {
  ScenePlay play;
  play.push({0, 0, 0}, {1, 0.7F, -0.3F});
  for (int i = 0; i < 300'000; ++i) play.update(33);
  EXPECT_LT((play.turn().transpose() * play.turn() - Eigen::Matrix3f::Identity()).norm(), 1e-3F);
}

TEST(SceneBounds, WhateverAHandSaysTheViewIsOneThatCanBeDrawn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scene::SceneSettings settings;
  for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e30F, 3e38F, 1e-40F}) {
    for (const bool grab : {true, false}) {
      ScenePlay play(settings);
      play.input.grab = grab;
      play.input.fly = !grab;
      play.holdHand({1, 0, 0});
      play.update(33);
      play.holdHand({bad, -bad, bad});
      std::fill_n(play.input.hand->orientation_wxyz, 4, bad);
      play.update(33);
      play.update(33);
      EXPECT_TRUE(play.scene.view().T_eye_model.matrix().allFinite()) << bad;
      EXPECT_LE(play.position().norm(), 2.001F * render::scene::Scene::kWorld_m) << bad;
      play.holdHand({1, 0, 0});
      play.update(33);
      play.scene.reset();
      play.update(33);
      play.input.grab = play.input.fly = false;
      play.update(33);
      expectAt(play, {0, 0, -2});
    }
  }
}

}  // namespace
}  // namespace merlin::render
