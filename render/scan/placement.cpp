#include "render/scan/placement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace merlin::render::scan {
namespace {

range::Pose poseOf(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& at) {
  range::Pose pose{};
  for (int row = 0; row < 3; ++row) {
    double* out = &pose[4 * static_cast<std::size_t>(row)];
    for (int column = 0; column < 3; ++column) out[column] = rotation(row, column);
    out[3] = at[row];
  }
  return pose;
}

}  // namespace

range::Pose lookAt(const Point& from, const Point& at) {
  const Eigen::Vector3d eye(from.data()), target(at.data());
  const Eigen::Vector3d back = (eye - target).stableNormalized();
  constexpr double kAlmostUp = 0.9999;
  const Eigen::Vector3d up =
      std::abs(back.y()) < kAlmostUp ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, -1);
  Eigen::Matrix3d rotation;
  rotation.col(2) = back;
  rotation.col(0) = up.cross(back).normalized();
  rotation.col(1) = back.cross(rotation.col(0));
  return poseOf(rotation, eye);
}

range::Pose around(const mesh::Box& box, double yaw_rad, double pitch_rad,
                   const range::Geometry& geometry) {
  constexpr double kMost = 1.5;  // limit [rad]: the distance does not shrink for wider views
  const double half = std::min({geometry.horizontal_rad / 2, geometry.vertical_rad / 2, kMost});
  const double distance = double{box.diagonal()} / 2 / std::sin(half);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Matrix3d rotation = turn.transpose();
  const Point centre = centreOf(box);
  return poseOf(rotation, Eigen::Vector3d(centre.data()) + distance * rotation.col(2));
}

Point centreOf(const mesh::Box& box) {
  Point centre;
  for (std::size_t k = 0; k < 3; ++k) centre[k] = (double{box.low[k]} + double{box.high[k]}) / 2;
  return centre;
}

}  // namespace merlin::render::scan
