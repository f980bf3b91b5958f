// Scene: what the devices say becomes where the model and the viewer are. Pure: no clock, no GL.
//
// Wall frame: the eye at the origin, x right, y up, -z into the wall, metres. T_a_b takes
// b-coordinates to a-coordinates.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/samples.h"
#include "render/scene/settings.h"

namespace merlin::render {

// Input of one frame. A device that is absent, or has not worked for a while, is left out.
struct SceneInput {
  std::optional<BallSample> ball;
  std::optional<TrackerSample> hand;
  bool grab = false, fly = false, point_at = false;  // actions that are held
  std::uint32_t reset_view = 0, next_mode = 0;       // times that they were asked for
};

enum class BallMode { kObject, kFly };  // the ball moves the model; the viewer

// Where the hand's ray ends, metres.
struct Pointed {
  Eigen::Vector3f at_eye_m = Eigen::Vector3f::Zero();    // in eye coordinates
  Eigen::Vector3f at_model_m = Eigen::Vector3f::Zero();  // in the model's coordinates
  bool on_model = false;                                 // on its bounding sphere, else on the wall
};

struct SceneView {
  Eigen::Isometry3f T_eye_model;  // model in metres, its bounding sphere's centre at its origin
  BallMode mode = BallMode::kObject;
  bool grabbed = false;
  bool moving = false;             // an input is above its noise, or was within still_after_s
  std::optional<Pointed> pointed;  // while a hand points; that is no motion
};

class Scene {
 public:
  // Errors: kInvalidArgument (an axis map that is not a right-handed permutation).
  static Result<Scene> make(const SceneSettings& settings);

  // Once a frame. `now` never falls. Cost: microseconds. Whatever `input` holds, both of the poses
  // behind the view stay rotations of norm 1 within kWorld_m of where they started from, or the
  // start view returns.
  SceneView update(const SceneInput& input, Timestamp now);

  // Where it would be drawn without any further input.
  const SceneView& view() const noexcept { return view_; }

  static constexpr float kWorld_m = 10'000;

  void reset();  // model and viewer back to the start; counts as motion
  void nextMode();

 private:
  explicit Scene(const SceneSettings& settings);
  bool moveByBall(const SceneInput& input, float seconds);
  bool moveByHand(const SceneInput& input, bool grab);
  bool flyByHand(const SceneInput& input, bool fly, float seconds);
  std::optional<Pointed> pointByHand(const SceneInput& input) const;
  void bound();  // see update()
  Eigen::Isometry3f handPose(const TrackerSample& sample) const;

  SceneSettings settings_;
  Eigen::Isometry3f T_wall_model_, T_wall_eye_;
  // While grabbed: where hand and model were when it began, and where the hand last counted.
  std::optional<Eigen::Isometry3f> grab_hand_, grab_model_;
  Eigen::Isometry3f last_hand_ = Eigen::Isometry3f::Identity();
  SceneView view_;
  Timestamp last_update_{}, last_motion_{};
  Eigen::Matrix3f R_wall_tracker_;
  std::optional<Eigen::Vector3f> fly_hand_;  // while flying: where the hand was when it began
  BallMode mode_ = BallMode::kObject;
  bool jumped_ = false;  // since the last update
};

}  // namespace merlin::render
