#include "render/scene/scene.h"
#include "tests/render/scene_play.h"

namespace merlin::test {
namespace {

// Returns settings in which the tracker's axes are those of the wall, and its transmitter is 0.5 m
// below the eye. The model is a sphere of radius 0.5 m at 2 m distance; the wall is 3 m away.
SceneSettings pointing() {
  SceneSettings s;
  s.model_radius_m = 0.5;
  s.tracker_axes = {1, 2, 3};
  s.tracker_origin_m = {0, -0.5, 0};
  s.wall_distance_m = 3;
  return s;
}

ScenePlay pointingFrom(const Vector3f& hand,
                       const Eigen::Matrix3f& turn = Eigen::Matrix3f::Identity()) {
  ScenePlay play(pointing());
  play.rest();
  play.input.point_at = true;
  play.holdHand(hand, turn);
  play.update(20);
  return play;
}

void expectPoint(const Vector3f& got, const Vector3f& want) {
  EXPECT_LT((got - want).norm(), 1e-4F) << got.transpose() << ", not " << want.transpose();
}

// From eye height, the ray is the viewing axis, which enters the sphere 1.5 m away.
TEST(ScenePointing, TheRayEntersTheModelsSphere) {
  const ScenePlay play = pointingFrom({0, 0.5F, 0});
  const auto& pointed = play.scene.view().pointed;
  ASSERT_TRUE(pointed);
  EXPECT_TRUE(pointed->on_model);
  expectPoint(pointed->at_eye_m, {0, 0, -1.5F});
  expectPoint(pointed->at_model_m, {0, 0, 0.5F});
  EXPECT_FALSE(play.scene.view().moving) << "the picture may stay as fine as it is";
}

TEST(ScenePointing, ItsPlaceIsInTheModelsOwnAxes) {
  ScenePlay play = pointingFrom({0.3F, 0.5F, 0});  // 0.4 = sqrt(0.5^2 - 0.3^2)
  expectPoint(play.scene.view().pointed->at_model_m, {0.3F, 0, 0.4F});
  play.push(Vector3f::Zero(), {0, 1, 0});
  for (int i = 0; i < 10; ++i) play.update(100);
  const Vector3f at_eye = play.scene.view().pointed->at_eye_m;
  expectPoint(at_eye, {0.3F, 0, -1.6F});
  expectPoint(play.scene.view().pointed->at_model_m,
              play.turn().transpose() * (at_eye - play.position()));
}

TEST(ScenePointing, PastTheModelItHitsTheWall) {
  const ScenePlay play = pointingFrom({0.6F, 0.5F, 0});
  const auto& pointed = play.scene.view().pointed;
  ASSERT_TRUE(pointed);
  EXPECT_FALSE(pointed->on_model);
  expectPoint(pointed->at_eye_m, {0.6F, 0, -std::sqrt(9 - 0.36F)});
}

// The hand is turned by 90 degrees to the left, so it points to the left and away from the model.
TEST(ScenePointing, FollowsTheHandsTurn) {
  const ScenePlay play = pointingFrom({0, 0.5F, 0}, turnedBy(90, Vector3f::UnitY()));
  ASSERT_TRUE(play.scene.view().pointed);
  expectPoint(play.scene.view().pointed->at_eye_m, {-3, 0, 0});
}

TEST(ScenePointing, TheModelBehindTheHandIsNotHit) {
  const ScenePlay play = pointingFrom({0, 0.5F, -2.6F});
  ASSERT_TRUE(play.scene.view().pointed);
  EXPECT_FALSE(play.scene.view().pointed->on_model);
  expectPoint(play.scene.view().pointed->at_eye_m, {0, 0, -3});
}

TEST(ScenePointing, EndsWithTheActionOrTheTracker) {
  ScenePlay play = pointingFrom({0, 0.5F, 0});
  play.input.point_at = false;
  EXPECT_FALSE(play.update(20).pointed);
  play.input.point_at = true;
  EXPECT_TRUE(play.update(20).pointed);
  play.input.hand.reset();
  EXPECT_FALSE(play.update(20).pointed);
}

}  // namespace
}  // namespace merlin::test
