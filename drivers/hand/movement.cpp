#include "drivers/hand/movement.h"

#include <algorithm>
#include <cmath>

namespace merlin::hand {
namespace {

constexpr double kFull = 2 * std::numbers::pi;
constexpr double kSpeedUp = 0.15;  // share of a circle's time for speeding up, and for slowing down

void addShare(Vector3& to, const Vector3& what, double share = 1) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += share * what[i];
}

void addShare(HandState& to, const HandState& what, double share = 1) {
  addShare(to.position_m, what.position_m, share);
  addShare(to.turn_rad, what.turn_rad, share);
}

// Returns the share of a circle that is done after `share` of its time: the speed rises, stays
// constant, and falls.
double evenly(double share) {
  const double x = std::clamp(share, 0.0, 1.0), a = kSpeedUp, top = 1 / (1 - a);
  if (x < a) return top * x * x / (2 * a);
  if (x > 1 - a) return 1 - top * (1 - x) * (1 - x) / (2 * a);
  return top * (x - a / 2);
}

// Returns the point of the ellipse at an angle, which is 0 at the top and increases clockwise, as
// the person sees it.
Vector3 onEllipse(const Move& move, double angle) {
  const double right = move.radius_m[0] * std::sin(angle);
  return {right * std::cos(move.plane_rad), move.radius_m[1] * std::cos(angle),
          right * std::sin(move.plane_rad)};
}

// Returns the contribution of `move` to the hand's state after `share` of its time.
HandState partOf(const Move& move, double share) {
  const double s = minimumJerk(std::pow(std::clamp(share, 0.0, 1.0), move.skew));
  HandState part{};
  addShare(part, move.way, s);
  addShare(part.position_m, move.bow_m, 4 * s * (1 - s));
  if (move.turns == 0) return part;
  addShare(part.position_m, onEllipse(move, move.start_rad + move.turns * kFull * evenly(share)));
  addShare(part.position_m, onEllipse(move, move.start_rad), -1);
  return part;
}

}  // namespace

double minimumJerk(double share) {
  const double x = std::clamp(share, 0.0, 1.0);
  return x * x * x * (10 + x * (-15 + 6 * x));
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion aboutAxis(std::size_t axis, double angle_rad) {
  Quaternion q{std::cos(angle_rad / 2), 0, 0, 0};
  q[axis + 1] = std::sin(angle_rad / 2);
  return q;
}

Vector3 rotated(const Quaternion& q, const Vector3& v) {
  const Quaternion turned = product(product(q, {0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {turned[1], turned[2], turned[3]};
}

Quaternion orientationOf(const HandState& state) {
  const auto& [pitch, yaw, roll] = state.turn_rad;
  return product(product(aboutAxis(1, yaw), aboutAxis(0, pitch)), aboutAxis(2, -roll));
}

HandState Movement::at(double t_s) {
  const auto ended = [&](const Move& m) { return t_s >= m.begin_s + m.seconds; };
  for (const Move& move : moves_) {
    if (ended(move)) addShare(base_, partOf(move, 1));
  }
  std::erase_if(moves_, ended);
  HandState state = base_;
  for (const Move& move : moves_) {
    if (t_s > move.begin_s) addShare(state, partOf(move, (t_s - move.begin_s) / move.seconds));
  }
  return state;
}

HandState Movement::end() const {
  HandState state = base_;
  for (const Move& move : moves_) addShare(state, partOf(move, 1));
  return state;
}

}  // namespace merlin::hand
