// Fingers on a touch surface: how their common motion is measured, and how the content follows that
// motion.
#include "render/scene/touch.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/scene/scene.h"

namespace merlin::render::scene {
namespace {

using content::Navigation;
using Eigen::Vector3f;

struct Finger {
  std::uint32_t id;
  float right, down;  // shares of the surface's width and height
};

TouchSample touch(std::initializer_list<Finger> fingers) {
  TouchSample sample{};
  sample.aspect = 2;
  for (const Finger& f : fingers) {
    sample.id[sample.fingers] = f.id;
    sample.position[sample.fingers][0] = f.right;
    sample.position[sample.fingers][1] = f.down;
    ++sample.fingers;
  }
  return sample;
}

TouchMotion between(const TouchSample& before, const TouchSample& now) {
  TouchFollower follower;
  EXPECT_FALSE(follower.update(&before).moves()) << "they have just come";
  return follower.update(&now);
}

TEST(Touch, AFingerThatMovesDrags) {
  const TouchMotion motion = between(touch({{7, 0.2F, 0.5F}}), touch({{7, 0.3F, 0.4F}}));
  EXPECT_EQ(motion.fingers, 1u);
  EXPECT_NEAR(motion.right, 0.2F, 1e-6F) << "a tenth of the width is two tenths of the height";
  EXPECT_NEAR(motion.up, 0.1F, 1e-6F);
  EXPECT_EQ(motion.spread, 0);
  EXPECT_EQ(motion.turn_rad, 0);
}

TEST(Touch, TwoFingersPinchAndTurnAboutTheirMiddle) {
  const TouchSample before = touch({{1, 0.4F, 0.5F}, {2, 0.6F, 0.5F}});  // 0.4 heights apart
  const TouchMotion apart = between(before, touch({{2, 0.7F, 0.5F}, {1, 0.3F, 0.5F}}));
  EXPECT_NEAR(apart.spread, std::log(2.0F), 1e-6F);
  EXPECT_NEAR(apart.right, 0, 1e-6F);
  EXPECT_NEAR(apart.turn_rad, 0, 1e-6F);
  const TouchMotion turned = between(before, touch({{1, 0.5F, 0.7F}, {2, 0.5F, 0.3F}}));
  EXPECT_NEAR(turned.turn_rad, M_PI_2, 1e-6) << "the right finger went up: counter-clockwise";
  EXPECT_NEAR(turned.spread, 0, 1e-6F);
}

TEST(Touch, AMousesWheelSpreads) {
  TouchSample mouse{};
  mouse.wheel = 65535;
  TouchFollower follower;
  EXPECT_FALSE(follower.update(&mouse).moves()) << "its count so far";
  mouse.wheel = 1;
  EXPECT_FLOAT_EQ(follower.update(&mouse).spread, 2 * TouchFollower::kPerNotch);
  EXPECT_FALSE(follower.update(&mouse).moves());
  mouse.wheel = 0;
  EXPECT_FLOAT_EQ(follower.update(&mouse).spread, -TouchFollower::kPerNotch);
  EXPECT_FALSE(follower.update(nullptr).moves());
  mouse.wheel = 40;
  EXPECT_FALSE(follower.update(&mouse).moves()) << "it was unplugged meanwhile";
}

TEST(Touch, AWheelTurnsBesideFingersThatSpread) {
  TouchSample before = touch({{1, 0.4F, 0.5F}, {2, 0.6F, 0.5F}});
  TouchSample now = touch({{1, 0.3F, 0.5F}, {2, 0.7F, 0.5F}});
  now.wheel = 1;
  EXPECT_NEAR(between(before, now).spread, std::log(2.0F) + TouchFollower::kPerNotch, 1e-6F);
}

TEST(Touch, AFingerThatComesOrGoesMovesNothing) {
  const TouchSample one = touch({{1, 0.4F, 0.5F}});
  EXPECT_FALSE(between(one, touch({{1, 0.4F, 0.5F}, {2, 0.9F, 0.9F}})).moves());
  EXPECT_FALSE(between(touch({{1, 0.4F, 0.5F}, {2, 0.9F, 0.9F}}), one).moves());
  EXPECT_FALSE(between(one, touch({{2, 0.1F, 0.1F}})).moves()) << "another finger";
  TouchFollower follower;
  (void)follower.update(&one);
  EXPECT_EQ(follower.update(nullptr).fingers, 0u) << "the device is lost";
  const TouchSample elsewhere = touch({{1, 0.8F, 0.5F}});
  EXPECT_FALSE(follower.update(&elsewhere).moves()) << "it came back";
}

TEST(Touch, FingersInOnePlaceHaveNoDirection) {
  const TouchMotion motion =
      between(touch({{1, 0.5F, 0.5F}, {2, 0.5F, 0.5F}}), touch({{1, 0.4F, 0.5F}, {2, 0.6F, 0.5F}}));
  EXPECT_EQ(motion.turn_rad, 0);
  EXPECT_EQ(motion.spread, 0);
}

class TouchedSceneTest : public testing::Test {
 protected:
  Eigen::Isometry3f after(Navigation navigation, const TouchMotion& motion) {
    scene_.setNavigation(navigation);
    SceneInput input;
    (void)scene_.update(input, now_);
    input.touch = motion;
    return scene_.update(input, now_ + std::chrono::milliseconds(33)).T_eye_model;
  }
  Scene scene_ = *Scene::make({.model_radius_m = 1, .model_distance_m = 2});
  Timestamp now_ = fromNanoseconds(1'000'000'000);
};

TEST_F(TouchedSceneTest, OneFingerTurnsAnObject) {
  const auto pose = after(Navigation::kObject, {1, 0.5F, 0, 0, 0});
  EXPECT_TRUE(pose.translation().isApprox(Vector3f(0, 0, -2)));
  EXPECT_TRUE((pose.linear() * Vector3f::UnitZ()).isApprox(Vector3f::UnitX(), 1e-5F))
      << "its front to the right";
}

TEST_F(TouchedSceneTest, TwoFingersMoveTurnAndApproachAnObject) {
  const auto moved = after(Navigation::kObject, {2, 0.2F, 0.1F, 0, 0});
  EXPECT_TRUE(moved.translation().isApprox(Vector3f(0.3F, 0.15F, -2), 1e-5F));
  scene_.reset();
  const auto nearer = after(Navigation::kObject, {2, 0, 0, std::log(2.0F), 0.25F});
  EXPECT_TRUE(nearer.translation().isApprox(Vector3f(0, 0, -1), 1e-5F)) << "twice as large";
  EXPECT_NEAR(Eigen::AngleAxisf(nearer.linear()).angle(), 0.25F, 1e-5F);
}

TEST_F(TouchedSceneTest, APlaneFollowsEveryFingerAndZooms) {
  const auto moved = after(Navigation::kPlane, {1, 0.2F, 0.1F, 0, 0});
  EXPECT_TRUE(moved.translation().isApprox(Vector3f(0.3F, 0.15F, -2), 1e-5F));
  scene_.reset();
  EXPECT_NEAR(after(Navigation::kPlane, {2, 0, 0, std::log(2.0F), 0}).translation().z(), -1, 1e-5F);
}

TEST_F(TouchedSceneTest, RestingFingersLeaveTheWallStill) {
  (void)after(Navigation::kObject, {2, 0, 0, 0, 0});
  EXPECT_FALSE(scene_.update({}, now_ + std::chrono::seconds(10)).moving);
}

}  // namespace
}  // namespace merlin::render::scene
