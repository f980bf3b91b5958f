// Movement: describes the path of a hand as a sum of single moves, each with a bell-shaped speed.
// Pure.
//
// Moves that overlap in time are added up, so that one blends into the next, as in human movement.
// Sources: T. Flash, N. Hogan, "The coordination of arm movements: an experimentally confirmed
// mathematical model", J. Neuroscience 5, 1985 (minimum jerk); T. Flash, E. Henis, "Arm trajectory
// modifications during reaching towards visual targets", J. Cognitive Neuroscience 3, 1991 (sums).
#pragma once

#include <array>
#include <numbers>
#include <vector>

namespace merlin::hand {

using Vector3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w x y z

// Coordinates of a person who faces the wall: x right, y up, z from the wall to the person [m].
// `turn_rad`: pitch (fingers up), yaw (fingers to the left), roll (clockwise as the person sees it)
// against a hand that points straight ahead, along -z.
struct HandState {
  Vector3 position_m{};
  Vector3 turn_rad{};
};

// Returns the rotation of the hand, q_person_hand.
Quaternion orientationOf(const HandState& state);
Quaternion product(const Quaternion& a, const Quaternion& b);
Quaternion aboutAxis(std::size_t axis, double angle_rad);
Vector3 rotated(const Quaternion& q, const Vector3& v);

// One move: from begin_s on, for `seconds`, position and turn change by `way`. In addition, the
// path is bent, by `bow_m` in the middle of the way, and if `turns` is not 0, the hand moves along
// an ellipse.
struct Move {
  double begin_s = 0, seconds = 1;
  HandState way{};
  Vector3 bow_m{};
  double skew = 1;  // 1: the greatest speed is in the middle; above 1: later
  // The ellipse: radii to the right and up, number of times around (clockwise positive), the angle
  // at which it begins (0 is the top; clockwise positive), and the rotation of its plane about the
  // vertical axis.
  std::array<double, 2> radius_m{};
  double turns = 0, start_rad = 0, plane_rad = 0;
};

// Returns the share of a move, 0..1, that is done after `share` of its time. The speed is
// bell-shaped.
double minimumJerk(double share);

// Thread-bound.
class Movement {
 public:
  explicit Movement(const HandState& at) : base_(at) {}

  void add(const Move& move) { moves_.push_back(move); }
  // Returns the state of the hand at time `t_s`. REQUIRES: t_s is not below that of an earlier
  // call. Cost: linear in the moves that have not ended.
  HandState at(double t_s);
  // Returns the state of the hand after the end of all moves.
  HandState end() const;

 private:
  HandState base_;  // the start plus all moves that have ended
  std::vector<Move> moves_;
};

}  // namespace merlin::hand
