// Scene: computes the poses of the content and the viewer from the devices' input. Pure: no clock,
// no GL.
//
// Wall frame: the eye at the origin, x right, y up, -z into the wall, metres. T_a_b takes
// b-coordinates to a-coordinates.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/port/samples.h"
#include "render/scene/navigator.h"
#include "render/scene/settings.h"
#include "render/scene/touch.h"

namespace merlin::render::scene {

// Motion by keys, buttons and postures while they are held; each value is -1, 0 or 1. The turns are
// those of a model; in a panorama and in the mode fly they are those of the view.
struct HeldMotion {
  int right = 0, up = 0, nearer = 0;
  int turn_right = 0, turn_up = 0, roll_right = 0;

  bool moves() const {
    return right != 0 || up != 0 || nearer != 0 || turn_right != 0 || turn_up != 0 ||
           roll_right != 0;
  }
};

// Input of one frame. A device that is absent, or has failed for some time, has no sample.
struct SceneInput {
  std::optional<BallSample> ball;
  std::optional<TrackerSample> hand;
  bool grab = false, fly = false, point_at = false;  // held actions
  std::uint32_t reset_view = 0, next_mode = 0;  // how often each was requested since the last frame
  TouchMotion touch;                            // motion of the fingers on a touch surface
  std::vector<TrackerSample> other_pointers;    // hands that point, besides `hand`
  HeldMotion held;
  // Motion requested by the command `move` since the last frame; it is applied at once. A plane
  // cannot turn, so the rotation shifts it instead.
  Push step;
  float turn_rad_s = 0;  // speed at which the content turns by itself: see Navigator::turn()
};

// The point at which a hand points [m].
struct Pointed {
  Eigen::Vector3f at_eye_m = Eigen::Vector3f::Zero();    // in eye coordinates
  Eigen::Vector3f at_model_m = Eigen::Vector3f::Zero();  // in the model's coordinates
  bool on_model = false;  // the point is on the model's bounding sphere; false: on a sphere about
                          // the eye whose radius is the distance of the wall
};

struct SceneView {
  Eigen::Isometry3f T_eye_model;  // model in metres; origin: centre of its bounding sphere
  BallMode mode = BallMode::kObject;
  bool grabbed = false;
  bool moving = false;  // an input exceeds its noise, or did so within the last still_after_s
  std::vector<Pointed> others_pointed;  // one per entry of SceneInput::other_pointers
  std::optional<Pointed> pointed;       // while a hand points; pointing does not count as motion
};

class Scene {
 public:
  // Errors: kInvalidArgument (an axis map that is not a right-handed permutation).
  static Result<Scene> make(const SceneSettings& settings);

  // Moves content and viewer by the input of one frame and returns the view; to be called once a
  // frame. REQUIRES: `now` never decreases. Cost: microseconds. Whatever `input` contains, the
  // poses of content and viewer stay rigid (orthonormal rotations) and within kWorld_m of the wall
  // frame's origin; if a pose is not finite, the start view returns.
  SceneView update(const SceneInput& input, Timestamp now);

  // Returns the view of the last update() or reset().
  const SceneView& view() const noexcept { return view_; }

  static constexpr float kWorld_m = 10'000;

  void reset();  // returns model and viewer to their initial poses; counts as motion
  void nextMode();

  // Replaces the settings, from the next update() on; the poses stay, and the initial view becomes
  // that of the new settings. Errors: those of make(); nothing is replaced then.
  Result<Ok> configure(const SceneSettings& settings);

  // Sets how the content is moved from now on; initially kObject. If the kind of navigation
  // changes, the view becomes the start view of the new kind, which counts as motion. `nearest`:
  // minimum distance of a plane, as a multiple of the initial one.
  void setNavigation(content::Navigation navigation, float nearest = content::kNearestPlane);

 private:
  explicit Scene(const SceneSettings& settings);
  bool moveByBall(const SceneInput& input, float seconds);
  bool moveByStep(const SceneInput& input);
  bool moveByTouch(const TouchMotion& touch);
  bool moveByHeld(const HeldMotion& held, float seconds);
  bool turnByItself(const SceneInput& input, float seconds);
  bool moveByHand(const SceneInput& input, bool grab);
  bool flyByHand(const SceneInput& input, bool fly, float seconds);
  Pointed pointByHand(const TrackerSample& hand) const;
  void bound();  // see update()
  Eigen::Isometry3f handPose(const TrackerSample& sample) const;

  SceneSettings settings_;
  content::Navigation navigation_ = content::Navigation::kObject;
  float nearest_ = content::kNearestPlane;
  std::unique_ptr<const Navigator> navigator_;
  Poses poses_;
  // While the content is grabbed: the poses of hand, content and viewer at the beginning, and the
  // hand's pose at its last motion beyond noise.
  std::optional<Eigen::Isometry3f> grab_hand_;
  Poses grabbed_;
  Eigen::Isometry3f last_hand_ = Eigen::Isometry3f::Identity();
  SceneView view_;
  Timestamp last_update_{}, last_motion_{};
  Eigen::Matrix3f R_wall_tracker_;
  std::optional<Eigen::Vector3f> fly_hand_;  // while flying: the hand's position at the beginning
  BallMode mode_ = BallMode::kObject;
  bool jumped_ = false;  // the view was reset since the last update()
};

}  // namespace merlin::render::scene
