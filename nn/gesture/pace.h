// UsualPace: how fast a person usually moves, learned from the strokes that are no gestures. A
// gesture is a hasty motion, but one person's haste is another's usual pace. Pure.
#pragma once

namespace merlin::nn {

// Thread-bound, allocation-free. Begins with the pace of the average person.
class UsualPace {
 public:
  // How much faster the stroke is than this person's usual ones of its length: logarithm of the
  // ratio of their greatest speeds. Lengths [m] and speeds [m/s] as logarithms, as in
  // StrokeFeatures.
  float hasteOf(float log_length, float log_speed) const noexcept;

  // Takes a stroke that is no gesture. `roll_share`: share of the hand's roll in its way, -1..1.
  // The pace is the mean of all strokes at first, later of about the last fifteen. Short strokes
  // and turns of the hand are ignored.
  void learn(float log_length, float log_speed, float roll_share) noexcept;

 private:
  float usual_ = 0;           // mean logarithm of the ratio to the average person's speed
  float strokes_ = kAverage;  // strokes in this mean; the average person counts too
  static constexpr float kAverage = 3;
};

}  // namespace merlin::nn
