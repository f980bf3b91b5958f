// ScenePlay: a scene with inputs and a clock that the test controls.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "render/scene/scene.h"

namespace merlin::test {

using Eigen::Vector3f;
using render::scene::SceneInput;
using render::scene::SceneSettings;
using render::scene::SceneView;

inline constexpr float kRadian = std::numbers::pi_v<float> / 180;

inline Eigen::Matrix3f turnedBy(float degrees, const Vector3f& axis) {
  return Eigen::AngleAxisf(degrees * kRadian, axis.normalized()).toRotationMatrix();
}

class ScenePlay {
 public:
  explicit ScenePlay(const SceneSettings& settings = {})
      : scene(*render::scene::Scene::make(settings)) {
    update(0);
  }

  const SceneView& update(int after_ms) {
    now_ += std::chrono::milliseconds(after_ms);
    scene.update(input, now_);
    input.reset_view = input.next_mode = 0;
    input.step = {};
    return scene.view();
  }
  // Updates the scene until nothing moves.
  void rest() {
    for (int i = 0; i < 20; ++i) update(50);
    EXPECT_FALSE(scene.view().moving);
  }

  void push(const Vector3f& translation, const Vector3f& rotation = Vector3f::Zero()) {
    BallSample& b = ball();
    for (int k = 0; k < 3; ++k) {
      b.translation[k] = translation[k];
      b.rotation[k] = rotation[k];
    }
  }

  // Sets the hand's pose in the tracker's frame; the position is in metres.
  void holdHand(const Vector3f& position,
                const Eigen::Matrix3f& turn = Eigen::Matrix3f::Identity()) {
    const Eigen::Quaternionf q(turn);
    input.hand = TrackerSample{};
    std::copy_n(position.data(), 3, input.hand->position_m);
    const float wxyz[] = {q.w(), q.x(), q.y(), q.z()};
    std::copy_n(wxyz, 4, input.hand->orientation_wxyz);
  }
  Vector3f position() const { return scene.view().T_eye_model.translation(); }
  Eigen::Matrix3f turn() const { return scene.view().T_eye_model.linear(); }

  render::scene::Scene scene;
  SceneInput input;

 private:
  BallSample& ball() {
    if (!input.ball) input.ball = BallSample{};
    return *input.ball;
  }

  Timestamp now_{std::chrono::hours(1)};
};

inline void expectAt(const ScenePlay& play, const Vector3f& position,
                     const Eigen::Matrix3f& turn = Eigen::Matrix3f::Identity()) {
  EXPECT_TRUE((play.position() - position).norm() < 1e-4F)
      << "at " << play.position().transpose() << ", not " << position.transpose();
  EXPECT_TRUE(play.turn().isApprox(turn, 1e-4F)) << play.turn() << "\nnot\n" << turn;
}

}  // namespace merlin::test
