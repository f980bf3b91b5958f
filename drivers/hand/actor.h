// Actor: plans the motions of a synthetic person one after the other, and samples them as the
// person's tracker would. Pure, seeded. Used by movement_recording.
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
  Performance finish();  // samples the rest of the plan; the actor must not be used again

 private:
  void wait(double seconds);  // negative: the next move begins before the last one has ended
  void move(const HandState& way, double seconds, double bow = 0);
  // `seconds`: 0 chooses the time of an unhurried reach over this distance.
  void goTo(const Vector3& place, double roll_rad, double bow, double seconds = 0);
  double pace(double low_s, double high_s);  // a random duration, scaled by the person's tempo
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
  Movement hand_;  // the hand relative to the body
  Movement body_;  // where the person stands
  double planned_s_ = 1;
  double next_s_ = 0;  // time of the next record
  double gap_until_s_ = 0, gap_at_s_;
  std::int64_t last_ns_ = 0;
  std::uint32_t counter_ = 0;
  std::array<double, 6> phase_{};  // phases of sway and tremor
  Performance done_;
};

}  // namespace merlin::hand
