#include "render/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "daemon/base/radian.h"

namespace merlin::render::scene {
namespace {

// Longest time for which the ball and the flight move the view in one frame, even if the frame took
// longer.
constexpr float kLongestStep_s = 0.1F;
constexpr float kMostShear = 1e-4F;
// Angle by which a drag over the height of a picture turns an object or the view of a panorama. A
// plane moves about as far as the pointer, at the initial distance.
constexpr float kTurnPerHeight = std::numbers::pi_v<float>;
constexpr float kRadiiPerHeight = 1.5F;

// Limits the translation to kWorld_m, within which a float resolves 1 mm; nothing farther away is
// visible. Makes the rotation orthonormal again, since rounding errors of many rotations would
// shear the model. Returns false if the pose is not finite.
bool bounded(Eigen::Isometry3f& pose) {
  if (!pose.matrix().allFinite()) return false;
  const float away = pose.translation().stableNorm();
  if (away > Scene::kWorld_m) pose.translation() *= Scene::kWorld_m / away;
  const Eigen::Matrix3f error =
      pose.linear().transpose() * pose.linear() - Eigen::Matrix3f::Identity();
  if (error.cwiseAbs().maxCoeff() > kMostShear)
    pose.linear() = Eigen::Quaternionf(pose.linear()).normalized().toRotationMatrix();
  return true;
}

std::optional<Eigen::Matrix3f> axisMap(const std::array<int, 3>& axes) {
  Eigen::Matrix3f m = Eigen::Matrix3f::Zero();
  for (int row = 0; row < 3; ++row) {
    const int axis = axes[static_cast<std::size_t>(row)];
    if (axis == 0 || axis < -3 || axis > 3) return std::nullopt;  // else abs() may overflow
    m(row, std::abs(axis) - 1) = axis > 0 ? 1.0F : -1.0F;
  }
  if (std::abs(m.determinant() - 1) > 1e-6F) return std::nullopt;
  return m;
}

std::unique_ptr<const Navigator> makeNavigator(content::Navigation navigation,
                                               const SceneSettings& settings, float nearest) {
  switch (navigation) {
    case content::Navigation::kPlane: return std::make_unique<PlaneNavigator>(settings, nearest);
    case content::Navigation::kPanorama: return std::make_unique<PanoramaNavigator>(settings);
    case content::Navigation::kObject: break;
  }
  return std::make_unique<ObjectNavigator>(settings);
}

Eigen::Vector3f vector(const std::array<double, 3>& a) {
  return Eigen::Vector3d(a[0], a[1], a[2]).cast<float>();
}

struct Ray {
  Eigen::Vector3f from, direction;  // `direction` has length 1

  // Returns the point at which the ray enters a sphere; nullopt if it misses the sphere or begins
  // inside.
  std::optional<Eigen::Vector3f> enters(const Eigen::Vector3f& centre, float radius) const {
    const Eigen::Vector3f to = centre - from;
    const float along = to.dot(direction);
    const float inside = radius * radius - (to - along * direction).squaredNorm();
    if (inside < 0 || along * along < inside || along < 0) return std::nullopt;
    return from + (along - std::sqrt(inside)) * direction;
  }

  // Returns the point at which the ray leaves a sphere about the eye. If the ray begins outside:
  // the sphere's point in the ray's direction, as seen from the eye.
  Eigen::Vector3f leaves(float radius) const {
    const float along = -from.dot(direction);
    const float inside = radius * radius - (from + along * direction).squaredNorm();
    if (inside < 0 || from.norm() > radius) return radius * direction;
    return from + (along + std::sqrt(inside)) * direction;
  }
};

}  // namespace

Result<Scene> Scene::make(const SceneSettings& settings) {
  if (const SettingFaults faults = validate(settings); !faults.empty())
    return Error{Errc::kInvalidArgument, faults.front().what};
  return Scene(settings);
}

Scene::Scene(const SceneSettings& settings)
    : settings_(settings),
      navigator_(makeNavigator(navigation_, settings, nearest_)),
      R_wall_tracker_(*axisMap(settings.tracker_axes)) {
  reset();
}

Result<Ok> Scene::configure(const SceneSettings& settings) {
  if (const SettingFaults faults = validate(settings); !faults.empty())
    return Error{Errc::kInvalidArgument, faults.front().what};
  settings_ = settings;
  navigator_ = makeNavigator(navigation_, settings_, nearest_);
  R_wall_tracker_ = *axisMap(settings.tracker_axes);
  // A hand that grabs or flies starts again from where it is now.
  grab_hand_.reset();
  fly_hand_.reset();
  return Ok{};
}

void Scene::setNavigation(content::Navigation navigation, float nearest) {
  const bool same = navigation == navigation_;
  if (same && nearest == nearest_) return;
  navigation_ = navigation;
  nearest_ = nearest;
  navigator_ = makeNavigator(navigation, settings_, nearest);
  if (!same) reset();
}

void Scene::reset() {
  poses_ = navigator_->start();
  grab_hand_.reset();
  fly_hand_.reset();
  jumped_ = true;
  view_ = {poses_.T_wall_content, mode_, false, true, {}, std::nullopt};
}

void Scene::nextMode() { mode_ = mode_ == BallMode::kObject ? BallMode::kFly : BallMode::kObject; }

SceneView Scene::update(const SceneInput& input, Timestamp now) {
  const bool first = last_update_ == Timestamp{};
  const auto seconds = first ? 0.0F : static_cast<float>(toSeconds(now - last_update_));
  last_update_ = now;
  if (first) last_motion_ = now;
  if (input.reset_view > 0) reset();
  if (input.next_mode % 2 == 1) nextMode();
  const float step_s = std::clamp(seconds, 0.0F, kLongestStep_s);
  const bool pushed = moveByBall(input, step_s);
  const bool stepped = moveByStep(input);
  const bool touched = moveByTouch(input.touch);
  const bool held = moveByHeld(input.held, step_s);
  const bool turned = turnByItself(input, step_s);
  const bool carried = moveByHand(input, input.grab);
  const bool flown = flyByHand(input, input.fly && !input.grab, step_s);
  bound();
  if (std::exchange(jumped_, false) || pushed || stepped || touched || held || turned || carried ||
      flown)
    last_motion_ = now;
  view_.T_eye_model = poses_.T_wall_eye.inverse() * poses_.T_wall_content;
  view_.mode = mode_;
  view_.grabbed = grab_hand_.has_value();
  view_.moving = now - last_motion_ < fromSeconds(settings_.still_after_s);
  view_.pointed.reset();
  if (input.point_at && input.hand) view_.pointed = pointByHand(*input.hand);
  view_.others_pointed.clear();
  for (const TrackerSample& hand : input.other_pointers)
    view_.others_pointed.push_back(pointByHand(hand));
  return view_;
}

void Scene::bound() {
  if (!bounded(poses_.T_wall_content) || !bounded(poses_.T_wall_eye)) reset();
}

// Returns whether the ball is pushed or twisted at all.
bool Scene::moveByBall(const SceneInput& input, float seconds) {
  if (!input.ball) return false;
  const Eigen::Vector3f push(input.ball->translation[0], input.ball->translation[1],
                             input.ball->translation[2]);
  const Eigen::Vector3f twist(input.ball->rotation[0], input.ball->rotation[1],
                              input.ball->rotation[2]);
  if (push.isZero(0) && twist.isZero(0)) return false;
  const Eigen::Vector3f way = push.cwiseProduct(vector(settings_.ball_speed_m_s)) * seconds;
  const Eigen::Vector3f turn =
      twist.cwiseProduct(vector(settings_.ball_turn_deg_s)) * kRadian<float> * seconds;
  navigator_->push(poses_, {way, turn}, mode_);
  return true;
}

// A plane cannot be turned: instead it moves as far as with a drag that would turn an object by
// this angle, so that the same drag or key has an effect on each content. Returns whether a step is
// requested.
bool Scene::moveByStep(const SceneInput& input) {
  if (input.step.way_m.isZero(0) && input.step.turn_rad.isZero(0)) return false;
  Push step = input.step;
  if (navigation_ == content::Navigation::kPlane) {
    const Eigen::Vector3f heights(step.turn_rad.y(), -step.turn_rad.x(), 0);
    step.way_m +=
        heights / kTurnPerHeight * kRadiiPerHeight * static_cast<float>(settings_.model_radius_m);
  }
  navigator_->push(poses_, step, mode_);
  return true;
}

// Moves the content so that it follows the fingers. One finger turns an object, as a dragged mouse
// does in a window; two move it, turn it in the picture's plane, and bring it nearer as they move
// apart. Any number of fingers moves a plane or a panorama. Returns whether the fingers move.
bool Scene::moveByTouch(const TouchMotion& touch) {
  if (!touch.moves()) return false;
  const float height_m = kRadiiPerHeight * static_cast<float>(settings_.model_radius_m);
  const bool object = navigation_ == content::Navigation::kObject;
  Push push;
  if (navigation_ == content::Navigation::kPanorama || (object && touch.fingers < 2))
    push.turn_rad = {-touch.up * kTurnPerHeight, touch.right * kTurnPerHeight, 0};
  else
    push.way_m = {touch.right * height_m, touch.up * height_m, 0};
  if (object && touch.fingers >= 2) push.turn_rad.z() = touch.turn_rad;
  const float away = object ? view_.T_eye_model.translation().norm()
                            : static_cast<float>(settings_.model_distance_m);
  // Planes and panoramas themselves compute their zoom as an exponential function of the way.
  push.way_m.z() = object ? away * (1 - std::exp(-touch.spread)) : away * touch.spread;
  navigator_->push(poses_, push, BallMode::kObject);
  return true;
}

// Moves as fast as a ball that is pushed half way, since a key cannot be pushed less or more.
// Returns whether anything is held.
bool Scene::moveByHeld(const HeldMotion& held, float seconds) {
  constexpr float kShare = 0.5F;  // share of a full push of the ball
  constexpr float kNearerPerSecond = std::numbers::ln2_v<float>;
  if (!held.moves()) return false;
  const Eigen::Vector3f way(static_cast<float>(held.right), static_cast<float>(held.up), 0);
  const Eigen::Vector3f turn(static_cast<float>(-held.turn_up), static_cast<float>(held.turn_right),
                             0);
  // If the view turns, the content seems to turn in the opposite direction.
  const bool view = navigation_ == content::Navigation::kPanorama ||
                    (navigation_ == content::Navigation::kObject && mode_ == BallMode::kFly);
  const Eigen::Vector3f roll(0, 0, static_cast<float>(-held.roll_right));
  const Push push{
      way.cwiseProduct(vector(settings_.ball_speed_m_s).cwiseAbs()) * kShare * seconds,
      (roll + (view ? -turn : turn)).cwiseProduct(vector(settings_.ball_turn_deg_s).cwiseAbs()) *
          kRadian<float> * kShare * seconds};
  navigator_->push(poses_, push, mode_);
  moveByTouch({.spread = static_cast<float>(held.nearer) * kNearerPerSecond * seconds});
  return true;
}

// Turns a content that can turn by itself, if a speed is set. Returns whether it turned.
bool Scene::turnByItself(const SceneInput& input, float seconds) {
  return input.turn_rad_s != 0 && navigator_->turn(poses_, input.turn_rad_s * seconds);
}

// Returns whether the hand's motion exceeds the tracker's noise (at rest: twice the noise). At
// rest, smaller motions do not move the content; while the scene moves, it follows them too.
bool Scene::moveByHand(const SceneInput& input, bool grab) {
  if (!grab || !input.hand) {
    grab_hand_.reset();
    return false;
  }
  const Eigen::Isometry3f hand = handPose(*input.hand);
  if (!grab_hand_) {
    grab_hand_ = last_hand_ = hand;
    grabbed_ = poses_;
    return true;
  }
  const float gate = view_.moving ? 1.0F : 2.0F;
  const float way = (hand.translation() - last_hand_.translation()).norm();
  const float turn =
      Eigen::AngleAxisf(Eigen::Matrix3f(hand.linear() * last_hand_.linear().transpose())).angle();
  const bool moved = way > gate * static_cast<float>(settings_.hand_noise_m) ||
                     turn > gate * static_cast<float>(settings_.hand_noise_deg) * kRadian<float>;
  if (moved) last_hand_ = hand;
  if (!moved && !view_.moving) return false;
  navigator_->carry(poses_, grabbed_, *grab_hand_, hand);
  return moved;
}

// Rate control: the viewer's speed is proportional to the hand's distance from where it began;
// within twice the tracker's noise the viewer does not move.
bool Scene::flyByHand(const SceneInput& input, bool fly, float seconds) {
  if (!fly || !input.hand) {
    fly_hand_.reset();
    return false;
  }
  const Eigen::Vector3f hand = handPose(*input.hand).translation();
  if (!fly_hand_) fly_hand_ = hand;
  const Eigen::Vector3f way = hand - *fly_hand_;
  if (way.norm() <= 2 * static_cast<float>(settings_.hand_noise_m)) return false;
  navigator_->fly(poses_, way * static_cast<float>(settings_.fly_gain) * seconds);
  return true;
}

// A hand in the same orientation as the transmitter points straight into the wall, along -z.
Pointed Scene::pointByHand(const TrackerSample& sample) const {
  const Eigen::Isometry3f hand = handPose(sample);
  const Ray ray{vector(settings_.tracker_origin_m) + hand.translation(),
                hand.linear() * -Eigen::Vector3f::UnitZ()};
  const auto radius = static_cast<float>(settings_.model_radius_m);
  const auto wall = static_cast<float>(settings_.wall_distance_m);
  const auto model = ray.enters(view_.T_eye_model.translation(), radius);
  const Eigen::Vector3f at = model ? *model : ray.leaves(wall);
  return Pointed{at, view_.T_eye_model.inverse() * at, model.has_value()};
}

Eigen::Isometry3f Scene::handPose(const TrackerSample& s) const {
  const Eigen::Quaternionf q(s.orientation_wxyz[0], s.orientation_wxyz[1], s.orientation_wxyz[2],
                             s.orientation_wxyz[3]);
  const Eigen::Matrix3f R = q.normalized().toRotationMatrix();
  Eigen::Isometry3f hand = Eigen::Isometry3f::Identity();
  hand.linear() = R_wall_tracker_ * R * R_wall_tracker_.transpose();
  hand.translation() =
      R_wall_tracker_ * Eigen::Vector3f(s.position_m[0], s.position_m[1], s.position_m[2]);
  return hand;
}

}  // namespace merlin::render::scene
