#include "render/scene/navigator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/base/radian.h"

namespace merlin::render::scene {
namespace {

Eigen::Isometry3f isometry(const Eigen::Quaternionf& q, const Eigen::Vector3f& p) {
  Eigen::Isometry3f t = Eigen::Isometry3f::Identity();
  t.linear() = q.normalized().toRotationMatrix();
  t.translation() = p;
  return t;
}

Eigen::AngleAxisf rotation(const Eigen::Vector3f& turn_rad) {
  const float angle = turn_rad.norm();
  return {angle, angle > 0 ? Eigen::Vector3f(turn_rad / angle) : Eigen::Vector3f::UnitX()};
}

}  // namespace

ObjectNavigator::ObjectNavigator(const SceneSettings& settings)
    : hand_gain_(static_cast<float>(settings.hand_gain)) {
  const auto yaw = static_cast<float>(settings.model_yaw_deg) * kRadian<float>;
  const auto pitch = static_cast<float>(settings.model_pitch_deg) * kRadian<float>;
  const Eigen::Quaternionf turned = Eigen::AngleAxisf(yaw, Eigen::Vector3f::UnitY()) *
                                    Eigen::AngleAxisf(pitch, Eigen::Vector3f::UnitX());
  const Eigen::Vector3f place(0, 0, -static_cast<float>(settings.model_distance_m));
  start_ = {isometry(turned, place), Eigen::Isometry3f::Identity()};
}

Poses ObjectNavigator::start() const { return start_; }

void ObjectNavigator::push(Poses& poses, const Push& push, BallMode mode) const {
  const Eigen::AngleAxisf turned = rotation(push.turn_rad);
  if (mode == BallMode::kFly) {
    poses.T_wall_eye = poses.T_wall_eye * isometry(Eigen::Quaternionf(turned), push.way_m);
    return;
  }
  const Eigen::Matrix3f R_wall_eye = poses.T_wall_eye.linear();
  poses.T_wall_content.linear() = R_wall_eye * turned.toRotationMatrix() * R_wall_eye.transpose() *
                                  poses.T_wall_content.linear();
  poses.T_wall_content.translation() += R_wall_eye * push.way_m;
}

void ObjectNavigator::fly(Poses& poses, const Eigen::Vector3f& way_m) const {
  poses.T_wall_eye.translate(way_m);
}

bool ObjectNavigator::turn(Poses& poses, float angle_rad) const {
  push(poses, {Eigen::Vector3f::Zero(), {0, angle_rad, 0}}, BallMode::kObject);
  return true;
}

// The content rotates with the hand, about its own centre, and moves hand_gain_ times as far as the
// hand.
void ObjectNavigator::carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
                            const Eigen::Isometry3f& hand) const {
  const Eigen::Matrix3f R = hand.linear() * hand_then.linear().transpose();
  const Eigen::Matrix3f R_wall_eye = poses.T_wall_eye.linear();
  poses.T_wall_content.linear() =
      R_wall_eye * R * R_wall_eye.transpose() * grabbed.T_wall_content.linear();
  poses.T_wall_content.translation() =
      grabbed.T_wall_content.translation() +
      R_wall_eye * (hand.translation() - hand_then.translation()) * hand_gain_;
}

PlaneNavigator::PlaneNavigator(const SceneSettings& settings, float nearest)
    : hand_gain_(static_cast<float>(settings.hand_gain)),
      distance_m_(static_cast<float>(settings.model_distance_m)),
      radius_m_(static_cast<float>(settings.model_radius_m)),
      nearest_(nearest) {}

Poses PlaneNavigator::start() const {
  const Eigen::Vector3f place(0, 0, -distance_m_);
  return {isometry(Eigen::Quaternionf::Identity(), place), Eigen::Isometry3f::Identity()};
}

void PlaneNavigator::move(Poses& poses, const Poses& from, const Eigen::Vector3f& way_m) const {
  const Eigen::Vector3f was = from.T_wall_content.translation();
  const float zoom = std::exp(-way_m.z() / distance_m_);
  const float away = std::clamp(-was.z() * zoom, nearest_ * distance_m_, kFarthest * distance_m_);
  // Sideways, the same push moves what is seen by the same angle at any distance; what is in the
  // middle of the view stays there while it is zoomed.
  const float scale = away / distance_m_;
  const Eigen::Vector2f side = was.head<2>() + way_m.head<2>() * scale;
  const Eigen::Vector2f kept = side.cwiseMax(-radius_m_).cwiseMin(radius_m_);
  poses.T_wall_content.translation() << kept, -away;
}

void PlaneNavigator::push(Poses& poses, const Push& push, BallMode /*mode*/) const {
  move(poses, poses, push.way_m);
}

// The viewer would move by `way_m`, so the plane moves in the opposite direction.
void PlaneNavigator::fly(Poses& poses, const Eigen::Vector3f& way_m) const {
  move(poses, poses, -way_m);
}

bool PlaneNavigator::turn(Poses& /*poses*/, float /*angle_rad*/) const { return false; }

void PlaneNavigator::carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
                           const Eigen::Isometry3f& hand) const {
  move(poses, grabbed, (hand.translation() - hand_then.translation()) * hand_gain_);
}

PanoramaNavigator::PanoramaNavigator(const SceneSettings& settings)
    : hand_gain_(static_cast<float>(settings.hand_gain)),
      radius_m_(static_cast<float>(settings.model_radius_m)) {}

Poses PanoramaNavigator::start() const {
  return {Eigen::Isometry3f::Identity(), Eigen::Isometry3f::Identity()};
}

// The pose of a panorama is a rotation by its yaw, then one by its pitch, then a translation by its
// pull.
void PanoramaNavigator::look(Poses& poses, const Poses& from, float yaw, float pitch,
                             float nearer_m) const {
  const Eigen::Matrix3f R = from.T_wall_content.linear();
  const float new_yaw =
      std::remainder(std::atan2(R(0, 2), R(0, 0)) + yaw, 2 * std::numbers::pi_v<float>);
  const float new_pitch =
      std::clamp(std::atan2(R(2, 1), R(1, 1)) + pitch, -kMostPitch_rad, kMostPitch_rad);
  const float pulled =
      std::clamp(from.T_wall_content.translation().z() + nearer_m, 0.0F, kNearest * radius_m_);
  const Eigen::Quaternionf turned = Eigen::AngleAxisf(new_pitch, Eigen::Vector3f::UnitX()) *
                                    Eigen::AngleAxisf(new_yaw, Eigen::Vector3f::UnitY());
  poses.T_wall_content = isometry(turned, {0, 0, pulled});
}

// Pushing the ball to the right turns the view to the right, and so does twisting it to the right.
void PanoramaNavigator::push(Poses& poses, const Push& push, BallMode /*mode*/) const {
  look(poses, poses, push.way_m.x() - push.turn_rad.y(), -push.way_m.y() - push.turn_rad.x(),
       push.way_m.z());
}

void PanoramaNavigator::fly(Poses& poses, const Eigen::Vector3f& way_m) const {
  look(poses, poses, way_m.x(), -way_m.y(), -way_m.z());
}

bool PanoramaNavigator::turn(Poses& poses, float angle_rad) const {
  look(poses, poses, angle_rad, 0, 0);
  return true;
}

// The grabbed point follows the hand, so the view turns in the opposite direction.
void PanoramaNavigator::carry(Poses& poses, const Poses& grabbed,
                              const Eigen::Isometry3f& hand_then,
                              const Eigen::Isometry3f& hand) const {
  const Eigen::Vector3f way = (hand.translation() - hand_then.translation()) * hand_gain_;
  look(poses, grabbed, -way.x(), way.y(), way.z());
}

}  // namespace merlin::render::scene
