// The tracked hand grabs, carries and releases the model; noise of the tracker does not count as
// motion.
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/scene/scene.h"
#include "tests/render/scene_play.h"

namespace merlin::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using test::expectAt;
using test::ScenePlay;
using test::turnedBy;

const Vector3f kX = Vector3f::UnitX(), kY = Vector3f::UnitY(), kZ = Vector3f::UnitZ();
const Vector3f kStart(0, 0, -2);      // the model's default position
const Vector3f kHand(0.4F, 0.1F, 0);  // an arbitrary position in the tracker's frame

// Settings in which the tracker's axes are those of the wall, and the model moves three times as
// far as the hand.
scene::SceneSettings plain() { return {.tracker_axes = {1, 2, 3}, .hand_gain = 3}; }

// Returns a scene in which the hand has just grabbed the model.
ScenePlay grabbed(const scene::SceneSettings& settings = plain(),
                  const Matrix3f& hand_turn = Matrix3f::Identity()) {
  ScenePlay play(settings);
  play.rest();
  play.holdHand(kHand, hand_turn);
  play.input.grab = true;
  EXPECT_TRUE(play.update(20).grabbed);
  EXPECT_TRUE(play.scene.view().moving);
  return play;
}

TEST(SceneHand, MovesTheModelByTheGainWithoutAJumpAtTheGrab) {
  ScenePlay play = grabbed();
  expectAt(play, kStart);
  play.holdHand(kHand + Vector3f(0.1F, -0.05F, 0.2F));
  play.update(20);
  expectAt(play, kStart + Vector3f(0.3F, -0.15F, 0.6F));
  play.holdHand(kHand);
  play.update(20);
  expectAt(play, kStart);
}

TEST(SceneHand, HowLongAFrameTakesDoesNotMatter) {
  ScenePlay play = grabbed();
  play.holdHand(kHand + 0.1F * kX);
  play.update(0);
  expectAt(play, kStart + 0.3F * kX);
  play.update(60'000);
  expectAt(play, kStart + 0.3F * kX);
}

TEST(SceneHand, TurnsTheModelAsItTurnsAboutTheModelsCentre) {
  // The orientation of the hand when it grabs is arbitrary.
  const Matrix3f before = turnedBy(70, {1, 2, 3});
  scene::SceneSettings settings = plain();
  settings.model_yaw_deg = 30;
  ScenePlay play = grabbed(settings, before);
  expectAt(play, kStart, turnedBy(30, kY));
  play.holdHand(kHand, turnedBy(40, kX) * before);
  play.update(20);
  expectAt(play, kStart, turnedBy(40, kX) * turnedBy(30, kY));
  play.holdHand(kHand + 0.1F * kY, turnedBy(-90, {1, 1, 0}) * before);
  play.update(20);
  expectAt(play, kStart + 0.3F * kY, turnedBy(-90, {1, 1, 0}) * turnedBy(30, kY));
}

// By default, the wall's x is the tracker's -y, its y the tracker's -z, its z the tracker's x.
TEST(SceneHand, ItsAxesAreMapped) {
  const struct { Vector3f tracker, wall; } axes[] = {{-kY, kX}, {-kZ, kY}, {kX, kZ}};
  for (const auto& axis : axes) {
    ScenePlay play = grabbed({});
    play.holdHand(kHand + 0.1F * axis.tracker, turnedBy(50, axis.tracker));
    play.update(20);
    expectAt(play, kStart + 0.3F * axis.wall, turnedBy(50, axis.wall));
  }
}

TEST(SceneHand, CarriesAlongTheAxesOfAViewerWhoHasTurned) {
  ScenePlay play(plain());
  play.scene.nextMode();
  play.push(Vector3f::Zero(), kY);
  for (int i = 0; i < 10; ++i) play.update(100);  // a turn of 90 degrees to the left
  play.push(Vector3f::Zero());
  play.input.grab = true;
  play.holdHand(kHand);
  play.update(20);
  expectAt(play, {2, 0, 0}, turnedBy(-90, kY));
  play.holdHand(kHand + 0.1F * kX, turnedBy(30, kX));
  play.update(20);
  expectAt(play, {2.3F, 0, 0}, turnedBy(30, kX) * turnedBy(-90, kY));
}

// If the action ends or the tracker fails, the model is released. It stays where it is, and must
// not jump to the hand at the next grab.
TEST(SceneHand, WithoutTheActionOrTheTrackerItLetsGo) {
  for (const int gone : {0, 1}) {
    ScenePlay play = grabbed();
    play.holdHand(kHand + 0.1F * kX);
    play.update(20);
    if (gone == 0) play.input.grab = false;
    if (gone == 1) play.input.hand.reset();
    EXPECT_FALSE(play.update(20).grabbed) << gone;
    if (gone != 1) play.holdHand(kHand + kZ);
    play.update(20);
    expectAt(play, kStart + 0.3F * kX);
    play.holdHand(kHand - kX, turnedBy(90, kZ));
    play.input.grab = true;
    EXPECT_TRUE(play.update(20).grabbed);
    expectAt(play, kStart + 0.3F * kX);
    play.holdHand(kHand - kX + 0.1F * kY, turnedBy(90, kZ));
    play.update(20);
    expectAt(play, kStart + 0.3F * kX + 0.3F * kY);
  }
}

TEST(SceneHand, ResetWhileItHoldsBeginsANewGrab) {
  ScenePlay play = grabbed();
  play.holdHand(kHand + 0.1F * kX, turnedBy(20, kY));
  play.update(20);
  play.input.reset_view = 1;
  EXPECT_TRUE(play.update(20).grabbed);
  expectAt(play, kStart);
  play.update(20);
  expectAt(play, kStart);
  play.holdHand(kHand + 0.2F * kX, turnedBy(20, kY));
  play.update(20);
  expectAt(play, kStart + 0.3F * kX);
}

TEST(SceneHand, MotionEndsThoughTheFistStays) {
  ScenePlay play = grabbed();
  EXPECT_TRUE(play.update(149).moving);
  EXPECT_FALSE(play.update(1).moving);
  EXPECT_TRUE(play.scene.view().grabbed);
}

// The thresholds of noise are 3 mm and 0.6 degrees; from rest they are twice as large.
TEST(SceneHand, LeavesRestBeyondTwiceItsNoise) {
  const struct {
    Vector3f by;
    float turn_deg;
    bool moves;
  } cases[] = {{0.0059F * kX, 0, false}, {0.0061F * kX, 0, true}, {0.0061F * kZ, 0, true},
               {0 * kX, 1.15F, false},   {0 * kX, 1.25F, true},   {0.0058F * kY, 1.15F, false}};
  for (const auto& c : cases) {
    ScenePlay play = grabbed();
    play.rest();
    play.holdHand(kHand + c.by, turnedBy(c.turn_deg, kZ));
    EXPECT_EQ(play.update(20).moving, c.moves) << c.by.transpose() << ", " << c.turn_deg;
    expectAt(play, c.moves ? kStart + 3 * c.by : kStart, turnedBy(c.moves ? c.turn_deg : 0, kZ));
  }
}

TEST(SceneHand, OnceMovingItsNoiseIsTheBound) {
  for (const bool moves : {false, true}) {
    ScenePlay play = grabbed();
    play.update(140);
    const Vector3f by = (moves ? 0.0031F : 0.0029F) * kX;
    play.holdHand(kHand + by);
    EXPECT_TRUE(play.update(5).moving);
    // While the scene moves, the model follows the hand in both cases.
    expectAt(play, kStart + 3 * by);
    EXPECT_EQ(play.update(100).moving, moves) << "the last motion was the hand's, or the grab";
  }
}

// A slow drift counts as motion once its distance from the place of the last motion is large
// enough.
TEST(SceneHand, ASlowDriftIsFollowedInTheEnd) {
  ScenePlay play = grabbed();
  play.rest();
  int moved = 0;
  for (int i = 1; i <= 100; ++i) {
    play.holdHand(kHand + 0.001F * static_cast<float>(i) * kX);
    play.update(200);  // long enough to come to rest
    moved += play.scene.view().moving ? 1 : 0;
  }
  EXPECT_GE(moved, 12);
  EXPECT_LE(moved, 17);  // one motion for every 6 mm, or slightly more
  EXPECT_GT(play.position().x(), 0.27F);
}

TEST(SceneHand, NoiseAtRestNeitherMovesNorCounts) {
  ScenePlay play = grabbed();
  play.rest();
  const Eigen::Isometry3f before = play.scene.view().T_eye_model;
  Random random(5);
  const auto noise = [&] { return static_cast<float>(random.uniform(-1, 1)); };
  for (int i = 0; i < 1000; ++i) {
    play.holdHand(kHand + 0.003F * Vector3f(noise(), noise(), noise()),
                  turnedBy(1.1F * noise(), {noise(), noise(), noise()}));
    ASSERT_FALSE(play.update(20).moving) << i;
    ASSERT_EQ(play.scene.view().T_eye_model.matrix(), before.matrix()) << i;
  }
}

}  // namespace
}  // namespace merlin::render
