#include "render/stereo/head.h"

#include <cmath>
#include <cstdlib>

#include <Eigen/Geometry>

#include "daemon/base/radian.h"

namespace merlin::render::stereo {
namespace {

// Further than any room is wide: a tracker that says so is broken.
constexpr double kFarthest_m = 1000;

Eigen::Matrix3d axisMap(const std::array<int, 3>& axes) {
  Eigen::Matrix3d map = Eigen::Matrix3d::Zero();
  for (std::size_t row = 0; row < 3; ++row)
    map(static_cast<int>(row), std::abs(axes[row]) - 1) = axes[row] > 0 ? 1 : -1;
  return map;
}

}  // namespace

Head::Head(const HeadSettings& settings, const tiles::Viewer& configured,
           const Eigen::Vector3d& eye_m, double still_after_s)
    : settings_(settings),
      configured_(configured),
      eye_m_(eye_m),
      still_after_(fromSeconds(still_after_s)),
      R_room_tracker_(axisMap(settings.axes)),
      anchor_(configured),
      view_{configured} {}

std::optional<tiles::Viewer> Head::viewerOf(const TrackerSample& s) const {
  const Eigen::Vector3d at = Eigen::Vector3f(s.position_m).cast<double>();
  const Eigen::Quaterniond q = Eigen::Quaternionf(s.orientation_wxyz[0], s.orientation_wxyz[1],
                                                  s.orientation_wxyz[2], s.orientation_wxyz[3])
                                   .cast<double>();
  if (!(at.norm() < kFarthest_m) || !(std::abs(q.norm() - 1) < 0.1)) return std::nullopt;
  const Eigen::Matrix3d R_tracker_head = q.normalized().toRotationMatrix();
  const Eigen::Matrix3d R_room_head =
      R_room_tracker_ * R_tracker_head * R_room_tracker_.transpose();
  const Eigen::Vector3d in_room = Eigen::Vector3d(settings_.origin_m.data()) +
                                  settings_.scale * Eigen::Vector3d(R_room_tracker_ * at);
  return tiles::Viewer{in_room - eye_m_, configured_.eyes_m.norm() * R_room_head.col(0)};
}

bool Head::isBeyondDeadBand(const tiles::Viewer& viewer) const {
  if ((viewer.place_m - anchor_.place_m).norm() > settings_.dead_band_m) return true;
  const double turn =
      std::atan2(viewer.eyes_m.cross(anchor_.eyes_m).norm(), viewer.eyes_m.dot(anchor_.eyes_m));
  return turn > settings_.dead_band_deg * kRadian<double>;
}

Head::View Head::update(const std::optional<TrackerSample>& sample, Timestamp now) {
  const std::optional<tiles::Viewer> seen = sample ? viewerOf(*sample) : std::nullopt;
  const tiles::Viewer viewer = seen.value_or(configured_);
  view_.tracked = seen.has_value();
  if (isBeyondDeadBand(viewer)) {
    anchor_ = viewer;
    last_motion_ = now;
  }
  view_.moving = last_motion_ && now - *last_motion_ < still_after_;
  if (view_.moving) view_.viewer = viewer;
  return view_;
}

}  // namespace merlin::render::stereo
