// UsualPace: learns how fast a person usually moves, from the strokes that are not gestures. A
// gesture is faster than ordinary motion, but the speed of ordinary motion differs between people.
// Pure.
#pragma once

namespace merlin::nn {

// Thread-bound, allocation-free. Begins with the pace of the average person.
class UsualPace {
 public:
  // Returns how much faster a stroke is than this person's usual strokes of the same length: the
  // natural logarithm of the ratio of their greatest speeds. The arguments are the natural
  // logarithms of the stroke's length [m] and greatest speed [m/s], as in StrokeFeatures.
  float hasteOf(float log_length, float log_speed) const noexcept;

  // Learns from a stroke that is not a gesture. `roll_share`: the stroke's feature "roll", -1..1.
  // The pace is the mean over all strokes at first, and later over about the last fifteen. Strokes
  // shorter than 0.15 m and strokes that are mainly a roll of the hand are ignored.
  void learn(float log_length, float log_speed, float roll_share) noexcept;

 private:
  float usual_ = 0;  // mean logarithm of the ratio to the average person's speed
  // Number of strokes in this mean, plus kAverage for the average person.
  float strokes_ = kAverage;
  static constexpr float kAverage = 3;
};

}  // namespace merlin::nn
