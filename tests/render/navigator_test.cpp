// How the ball moves the viewer in a plane and in a panorama. The navigator for models is tested
// through Scene.
#include "render/scene/navigator.h"

#include <gtest/gtest.h>

#include "render/scene/scene.h"

namespace merlin::render {
namespace {

using Eigen::Isometry3f;
using Eigen::Vector3f;

constexpr scene::SceneSettings kSettings = {
    .model_radius_m = 1, .model_distance_m = 2, .hand_gain = 3};

Isometry3f handAt(const Vector3f& p) {
  Isometry3f hand = Isometry3f::Identity();
  hand.translation() = p;
  return hand;
}

scene::Poses pushed(const scene::Navigator& navigator, const Vector3f& way_m,
                    const Vector3f& turn_rad = Vector3f::Zero()) {
  scene::Poses poses = navigator.start();
  navigator.push(poses, {way_m, turn_rad}, scene::BallMode::kObject);
  return poses;
}

// Returns a point of the content in eye coordinates.
Vector3f seen(const scene::Poses& poses, const Vector3f& point) {
  return poses.T_wall_eye.inverse() * poses.T_wall_content * point;
}

TEST(PlaneNavigator, MovesSidewaysAndNeverTurns) {
  const scene::PlaneNavigator navigator(kSettings);
  const scene::Poses poses = pushed(navigator, {0.25F, -0.5F, 0}, {1, 2, 3});
  EXPECT_TRUE(poses.T_wall_content.isApprox(handAt({0.25F, -0.5F, -2})));
  EXPECT_TRUE(poses.T_wall_eye.isApprox(Isometry3f::Identity()));
}

TEST(PlaneNavigator, ZoomsByTheSameFactorAtAnyDistance) {
  const scene::PlaneNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  float before = poses.T_wall_content.translation().z();
  for (int i = 0; i < 4; ++i) {
    navigator.push(poses, {{0, 0, 0.5F}}, scene::BallMode::kFly);
    const float now = poses.T_wall_content.translation().z();
    EXPECT_NEAR(now / before, std::exp(-0.25F), 1e-5F) << i;
    before = now;
  }
}

TEST(PlaneNavigator, StaysInFrontOfTheViewerAndInSight) {
  const scene::PlaneNavigator navigator(kSettings);
  for (const float z : {1e4F, -1e4F}) {
    const Vector3f at = pushed(navigator, {1e6F, -1e6F, z}).T_wall_content.translation();
    EXPECT_LE(at.z(), -2 * scene::PlaneNavigator::kNearest);
    EXPECT_GE(at.z(), -2 * scene::PlaneNavigator::kFarthest);
    EXPECT_EQ(at.x(), 1);
    EXPECT_EQ(at.y(), -1);
  }
}

// The viewer can come near enough to see single pixels of a picture of 100 gigapixels.
TEST(PlaneNavigator, GoesAsNearAsItsContentSays) {
  const scene::PlaneNavigator navigator(kSettings, 0.001F);
  EXPECT_FLOAT_EQ(pushed(navigator, {0, 0, 1e4F}).T_wall_content.translation().z(), -0.002F);
}

TEST(PlaneNavigator, GoesWithTheHandThatGrabsIt) {
  const scene::PlaneNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  navigator.carry(poses, poses, handAt({1, 1, 1}), handAt({1.1F, 1, 1}));
  EXPECT_NEAR(poses.T_wall_content.translation().x(), 0.3F, 1e-6F);
  const scene::Poses grabbed = navigator.start();
  navigator.fly(poses, {0.3F, 0, 0});
  EXPECT_TRUE(poses.T_wall_content.isApprox(grabbed.T_wall_content, 1e-6F));
}

TEST(PlaneNavigator, StandsStillForShow) {
  const scene::PlaneNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  EXPECT_FALSE(navigator.turn(poses, 0.5F));
  EXPECT_TRUE(poses.T_wall_content.isApprox(navigator.start().T_wall_content, 0));
}

// The view turns to the right: what was to the right of the viewer comes to the middle, and the
// horizon stays level.
TEST(PanoramaNavigator, TurnsToTheRightForShow) {
  const scene::PanoramaNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  EXPECT_TRUE(navigator.turn(poses, 0.5F));
  const Vector3f right(std::sin(0.5F), 0, -std::cos(0.5F));
  EXPECT_TRUE(seen(poses, right).isApprox(-Vector3f::UnitZ(), 1e-5F));
  EXPECT_TRUE((poses.T_wall_content.linear() * Vector3f::UnitY()).isApprox(Vector3f::UnitY()));
}

// The front of the model, which faces the viewer, moves to the right; the model's position does not
// change.
TEST(ObjectNavigator, TurnsAboutItsVerticalAxisForShow) {
  const scene::ObjectNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  EXPECT_TRUE(navigator.turn(poses, 0.5F));
  EXPECT_TRUE(seen(poses, Vector3f::UnitZ())
                  .isApprox(Vector3f(std::sin(0.5F), 0, std::cos(0.5F) - 2), 1e-5F));
  EXPECT_TRUE(seen(poses, Vector3f::Zero()).isApprox(Vector3f(0, 0, -2), 1e-5F));
}

// After a push to the right, what was to the right of the viewer is straight ahead.
TEST(PanoramaNavigator, LooksWhereTheBallIsPushedOrTwistedTo) {
  const scene::PanoramaNavigator navigator(kSettings);
  const Vector3f right(std::sin(0.5F), 0, -std::cos(0.5F)), up(0, std::sin(0.5F), -std::cos(0.5F));
  const Vector3f ahead = -Vector3f::UnitZ();
  EXPECT_TRUE(seen(pushed(navigator, {0.5F, 0, 0}), right).isApprox(ahead, 1e-5F));
  EXPECT_TRUE(seen(pushed(navigator, {0, 0.5F, 0}), up).isApprox(ahead, 1e-5F));
  const Vector3f none = Vector3f::Zero();
  EXPECT_TRUE(seen(pushed(navigator, none, {0, -0.5F, 0}), right).isApprox(ahead, 1e-5F));
  EXPECT_TRUE(seen(pushed(navigator, none, {0.5F, 0, 0}), up).isApprox(ahead, 1e-5F));
}

TEST(PanoramaNavigator, KeepsTheHorizonLevelHoweverItIsTurned) {
  const scene::PanoramaNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  for (int i = 0; i < 5000; ++i) {
    const float t = static_cast<float>(i);
    navigator.push(poses, {{}, {std::sin(t), std::cos(t / 3), std::sin(t / 7)}},
                   scene::BallMode::kFly);
    // The content's vertical axis is never tilted to the side.
    ASSERT_NEAR(seen(poses, Vector3f::UnitY()).x(), 0, 1e-5F) << i;
    ASSERT_GT(seen(poses, Vector3f::UnitY()).y(), 0.08F) << "never upside down, " << i;
  }
}

TEST(PanoramaNavigator, IsPulledNearerButNotThroughItsWall) {
  const scene::PanoramaNavigator navigator(kSettings);
  const auto pulled = [&](float z) {
    return pushed(navigator, {0, 0, z}).T_wall_content.translation().z();
  };
  EXPECT_FLOAT_EQ(pulled(0.2F), 0.2F);
  EXPECT_FLOAT_EQ(pulled(9), scene::PanoramaNavigator::kNearest);
  EXPECT_EQ(pulled(-1), 0);
}

TEST(PanoramaNavigator, GoesWithTheHandThatGrabsIt) {
  const scene::PanoramaNavigator navigator(kSettings);
  scene::Poses poses = navigator.start();
  navigator.carry(poses, poses, handAt({0, 0, 0}), handAt({0.1F, 0.05F, 0}));
  const Vector3f front = seen(poses, -Vector3f::UnitZ());
  EXPECT_GT(front.x(), 0.25F) << "to the right with the hand";
  EXPECT_GT(front.y(), 0.1F);
  EXPECT_GT(seen(poses, Vector3f::UnitX()).norm(), 0.99F);
}

TEST(SceneNavigation, AnotherKindBeginsAtItsOwnStart) {
  scene::Scene scene = *scene::Scene::make({.model_distance_m = 3, .model_yaw_deg = 40});
  scene.setNavigation(content::Navigation::kPlane);
  EXPECT_TRUE(scene.view().T_eye_model.isApprox(handAt({0, 0, -3})));
  EXPECT_TRUE(scene.view().moving);
  scene.setNavigation(content::Navigation::kPanorama);
  EXPECT_TRUE(scene.view().T_eye_model.isApprox(Isometry3f::Identity()));
  scene::SceneInput input;
  input.ball.emplace();
  input.ball->rotation[1] = 1;
  scene.update({}, Timestamp(Duration(1)));
  const scene::SceneView view = scene.update(input, Timestamp(fromSeconds(0.1)));
  EXPECT_FALSE(view.T_eye_model.linear().isIdentity(1e-3F)) << "it is turned";
  EXPECT_TRUE(view.T_eye_model.translation().isZero()) << "the viewer stays in the middle";
  scene.setNavigation(content::Navigation::kPanorama);
  EXPECT_EQ(scene.view().T_eye_model.matrix(), view.T_eye_model.matrix()) << "the same kind";
}

}  // namespace
}  // namespace merlin::render
