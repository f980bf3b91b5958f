#include "drivers/fastrak/guided_alignment.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "drivers/fastrak/protocol.h"

namespace merlin::fastrak {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr GuidedStep kSteps[] = {
    {"origin", "hold the station still at the place of the new origin"},
    {"x axis", "hold it still at a point on the new x axis, 10 cm from the origin or more"},
    {"y axis", "hold it still at a point on the new y axis, 10 cm from the origin or more"},
    {"straight ahead", "hold it still as it is worn when it points straight ahead"},
};

constexpr int kLeastSamples = 3;
// Ten times the unit's noise; a hand that is held still wanders by a few millimetres.
constexpr double kMostSpread_m = 0.01;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostSpread_rad = 3 * kDegree;
// At a distance of 10 cm, an error of 1 mm turns an axis by half a degree.
constexpr double kLeastDistance_m = 0.1;
constexpr double kLeastAngle_rad = 30 * kDegree;

// Origin and orientation of an aligned frame, in the transmitter's frame.
struct Alignment {
  explicit Alignment(const std::array<float, 9>& cm)
      : origin_m(place(cm, 0)), turn(axes(origin_m, place(cm, 3), place(cm, 6))) {}

  static Vector3d place(const std::array<float, 9>& cm, std::size_t at) {
    return Vector3d(cm[at], cm[at + 1], cm[at + 2]) / 100;
  }
  // The x axis goes through `on_x`; the y axis is perpendicular to it, on the side of `on_y`.
  static Quaterniond axes(const Vector3d& origin, const Vector3d& on_x, const Vector3d& on_y) {
    Eigen::Matrix3d m;
    m.col(0) = (on_x - origin).normalized();
    const Vector3d y = on_y - origin;
    m.col(1) = (y - y.dot(m.col(0)) * m.col(0)).normalized();
    m.col(2) = m.col(0).cross(m.col(1));
    return Quaterniond(m);
  }

  Vector3d origin_m;
  Quaterniond turn;
};

template <typename Wxyz>
Quaterniond quaternion(const Wxyz& q) {
  return {q[0], q[1], q[2], q[3]};
}
Vector3d position(const TrackerSample& s) {
  return {s.position_m[0], s.position_m[1], s.position_m[2]};
}
Vector3d position(const HeldPose& p) { return Vector3d(p.position_m.data()); }

HeldPose meanOf(std::span<const TrackerSample> samples) {
  Vector3d place = Vector3d::Zero();
  Eigen::Vector4d turn = Eigen::Vector4d::Zero();
  const Quaterniond first = quaternion(samples[0].orientation_wxyz);
  for (const TrackerSample& s : samples) {
    place += position(s) / static_cast<double>(samples.size());
    const Quaterniond q = quaternion(s.orientation_wxyz);
    // -q is the same rotation.
    turn += q.dot(first) < 0 ? Eigen::Vector4d(-q.coeffs()) : q.coeffs();
  }
  const Quaterniond mean(turn.normalized());
  HeldPose held;
  held.samples = static_cast<int>(samples.size());
  held.position_m = {place.x(), place.y(), place.z()};
  held.orientation_wxyz = {mean.w(), mean.x(), mean.y(), mean.z()};
  for (const TrackerSample& s : samples) {
    held.spread_m = std::max(held.spread_m, (position(s) - place).norm());
    held.spread_rad =
        std::max(held.spread_rad, mean.angularDistance(quaternion(s.orientation_wxyz)));
  }
  return held;
}

}  // namespace

std::span<const GuidedStep> alignmentSteps() { return kSteps; }

TrackerSample inTransmitterFrame(const TrackerSample& sample, const StationFrame& frame) noexcept {
  TrackerSample back = sample;
  Quaterniond turn = quaternion(sample.orientation_wxyz) * quaternion(frame.boresight_wxyz);
  if (frame.alignment_cm != FastrakSettings::kAligned) {
    const Alignment alignment(frame.alignment_cm);
    const Vector3d place = alignment.origin_m + alignment.turn * position(sample);
    for (Eigen::Index i = 0; i < 3; ++i) back.position_m[i] = static_cast<float>(place[i]);
    turn = alignment.turn * turn;
  }
  const std::array<double, 4> wxyz = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::transform(wxyz.begin(), wxyz.end(), back.orientation_wxyz,
                 [](double v) { return static_cast<float>(v); });
  return back;
}

void GuidedAlignment::begin(std::size_t step) {
  step_ = step;
  samples_.clear();
  error_ = ' ';
}

void GuidedAlignment::add(const TrackerSample& sample) {
  if (sample.error == ' ') {
    samples_.push_back(inTransmitterFrame(sample, present_));
  } else {
    error_ = sample.error;
  }
}

Result<HeldPose> GuidedAlignment::end() {
  held_[step_].reset();
  if (samples_.size() < kLeastSamples) {
    std::string what =
        fmt::format("{} samples came ({} are needed): ", samples_.size(), kLeastSamples);
    what += error_ == ' ' ? "is this station's receiver plugged in?"
                          : fmt::format("the unit reports error {} {}", error_, meaningOf(error_));
    return Error{Errc::kTimeout, what};
  }
  const HeldPose held = meanOf(samples_);
  if (held.spread_m > kMostSpread_m || held.spread_rad > kMostSpread_rad) {
    return Error{Errc::kMalformed,
                 fmt::format("it moved by {:.1f} cm and {:.1f} degrees ({:.0f} cm and {:.0f} "
                             "degrees are allowed): hold it still",
                             100 * held.spread_m, held.spread_rad / kDegree, 100 * kMostSpread_m,
                             kMostSpread_rad / kDegree)};
  }
  if (auto placed = checkPlace(held); !placed) return placed.error();
  held_[step_] = held;
  return held;
}

// Checks that this place and the earlier ones determine a frame.
Result<Ok> GuidedAlignment::checkPlace(const HeldPose& held) const {
  if (step_ != kOnX && step_ != kOnY) return Ok{};
  const Vector3d arm = position(held) - position(*held_[kOrigin]);
  if (arm.norm() < kLeastDistance_m) {
    return Error{Errc::kMalformed,
                 fmt::format("it is {:.1f} cm from the origin ({:.0f} cm are needed): go further "
                             "along the axis",
                             100 * arm.norm(), 100 * kLeastDistance_m)};
  }
  if (step_ == kOnX) return Ok{};
  const Vector3d x = position(*held_[kOnX]) - position(*held_[kOrigin]);
  const double angle = std::atan2(x.cross(arm).norm(), x.dot(arm));
  if (angle >= kLeastAngle_rad && angle <= std::numbers::pi - kLeastAngle_rad) return Ok{};
  return Error{
      Errc::kMalformed,
      fmt::format("seen from the origin it is {:.0f} degrees from the x axis ({:.0f} to {:.0f} "
                  "are needed): the three places are nearly on one line",
                  angle / kDegree, kLeastAngle_rad / kDegree, 180 - kLeastAngle_rad / kDegree)};
}

StationFrame GuidedAlignment::solve() const {
  assert(held_[kOrigin].has_value() == held_[kOnX].has_value() &&
         held_[kOrigin].has_value() == held_[kOnY].has_value());
  StationFrame solved = present_;
  if (held_[kOnY]) {
    for (std::size_t i = 0; i < 9; ++i) {
      const double cm = 100 * held_[i / 3]->position_m[i % 3];
      solved.alignment_cm[i] = static_cast<float>(std::round(100 * cm) / 100);  // as it is sent
    }
  }
  if (!held_[kAhead] && present_.boresight_wxyz == FastrakSettings::kAhead) return solved;
  const Quaterniond ahead =  // in the transmitter's frame
      held_[kAhead] ? quaternion(held_[kAhead]->orientation_wxyz)
                    : Alignment(present_.alignment_cm).turn * quaternion(present_.boresight_wxyz);
  const Quaterniond q = Alignment(solved.alignment_cm).turn.conjugate() * ahead;
  const double sign = q.w() < 0 ? -1 : 1;
  solved.boresight_wxyz = {static_cast<float>(sign * q.w()), static_cast<float>(sign * q.x()),
                           static_cast<float>(sign * q.y()), static_cast<float>(sign * q.z())};
  return solved;
}

}  // namespace merlin::fastrak
