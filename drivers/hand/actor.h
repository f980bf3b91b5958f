// Actor: strings together what a synthetic person does, and samples it as the person's tracker
// would. Pure, seeded. For movement_recording.
#pragma once

#include "drivers/hand/movement_recording.h"

namespace merlin::hand {

// Thread-bound.
class Actor {
 public:
  Actor(const MovingPerson& person, std::uint64_t seed);

  void makeGesture(const MovingGesture& gesture);
  void goAbout(Ordinary kind);

  double seconds() const { return planned_s_; }
  Performance finish();  // samples what was planned last; the actor is used up

 private:
  void wait(double seconds);  // less than 0: the next move begins before the last one has ended
  void move(const HandState& way, double seconds, double bow = 0);
  // `seconds`: 0 for an unhurried reach of this length.
  void goTo(const Vector3& place, double roll_rad, double bow, double seconds = 0);
  double pace(double low_s, double high_s);  // a duration of this person's
  Vector3 about(const Vector3& place, double deviation);

  void point();
  void reach();
  void turnModel();
  void scratch();
  void walk();
  void rest();
  void talk();

  // Samples up to planned_s_ - kAhead_s: later moves may begin before that.
  void sample(double until_s);
  void take(double t_s);

  const MovingPerson& person_;
  Random random_, noise_;
  Movement hand_;  // against the body
  Movement body_;  // where the person stands
  double planned_s_ = 1;
  double next_s_ = 0;  // of the next record
  double gap_until_s_ = 0, gap_at_s_;
  std::int64_t last_ns_ = 0;
  std::uint32_t counter_ = 0;
  std::array<double, 6> phase_{};  // of sway and tremor
  Performance done_;
};

}  // namespace merlin::hand
