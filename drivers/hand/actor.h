// Actor: plans the motions of a synthetic person one after the other, and samples them as the
// person's tracker would. Pure, seeded. Used by movement_recording.
#pragma once

#include "drivers/hand/movement_recording.h"

namespace merlin::hand {

// Thread-bound.
class Actor {
 public:
  Actor(const MovingPerson& person, std::uint64_t seed);

  // Plans one take of a gesture, with the way to its start and the movement after it.
  void makeGesture(const MovingGesture& gesture);
  // Plans one piece of ordinary motion.
  void goAbout(Ordinary kind);

  // Duration of the plan so far.
  double seconds() const { return planned_s_; }
  // Samples the rest of the plan and returns the recording; the actor must not be used afterwards.
  Performance finish();

 private:
  void wait(double seconds);  // if negative, the next move begins before the last one has ended
  void move(const HandState& way, double seconds, double bow = 0);
  // Moves the hand to `place`. If `seconds` is 0, the move takes as long as an unhurried reach over
  // this distance.
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

  // Takes the samples up to `until_s`. This is kAhead_s before the end of the plan until finish(),
  // because a later move may begin that much earlier.
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
