// Synthetic people who move: simulates how each of them makes gestures over time, and how a tracker
// on the hand measures the movement. Pure, seeded.
//
// Not measured on real people: README.md explains how the figures were chosen. Used for training,
// for tests and for benchmarks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "daemon/base/random.h"
#include "drivers/hand/movement.h"
#include "drivers/port/samples.h"

namespace merlin::hand {

// A gesture made over time, as the average person makes it.
struct MovingGesture {
  const char* name = "";
  double seconds = 1;   // duration; for a circle, that of one turn
  HandState way{};      // change of position and turn in a stroke
  double radius_m = 0;  // radius of a circle; 0: the gesture is a stroke
  double turns = 0;     // turns of a circle: 1 clockwise, -1 the other way
};

// Returns the gestures swipe_left, swipe_right, swipe_up, swipe_down, push, pull, circle_clockwise,
// circle_counterclockwise, twist_left and twist_right. Directions are as the person sees them.
std::span<const MovingGesture> movingGestures();
const MovingGesture* findMovingGesture(std::string_view name);  // nullptr if there is none

// Standard deviations: `person` between people, `habit` between the gestures of one person, `take`
// between the repetitions of one gesture. Those of size and time apply to the logarithm of a
// factor.
struct MoverSettings {
  double size_person = 0.14, size_habit = 0.12, size_take = 0.08;
  double time_person = 0.14, time_habit = 0.10, time_take = 0.09;
  double slant_habit_rad = 0.14, slant_take_rad = 0.07;  // direction of a stroke
  double body_yaw_rad = 0.20, body_lean_rad = 0.09;      // how the body faces the wall
  // Angle by which the receiver is mounted askew, about each axis.
  double mount_rad = 0.10;
  double bow_habit = 0.08, bow_take = 0.04;  // bend of a stroke, share of its length
};

// Errors of a tracker's measurement. They are drawn at random for each person.
struct TrackerTraits {
  double rate_hz = 120;
  double jitter_s = 0.001;                      // standard deviation of a record's arrival
  double position_m = 0.001, turn_rad = 0.004;  // deviation of the noise
  double lost = 0.01;                           // share of single records that are lost
  double gap_every_s = 20;  // mean time between gaps of up to a quarter of a second
};

// Thread-safe: immutable. Seed 0 is the average person; each other seed is a different one.
class MovingPerson {
 public:
  explicit MovingPerson(std::uint64_t seed, const MoverSettings& settings = {});

  // The moves of one take of a gesture, each with begin_s 0: `stroke` is the gesture itself, and
  // some people swing back before a stroke (`windup`, if `winds_up` is true).
  struct Take {
    Move windup, stroke;
    bool winds_up = false;
  };
  Take take(const MovingGesture& gesture, Random& random) const;

  // body(): rotation from the person's frame to the wall's. mount(): rotation of the receiver on
  // the hand.
  const Quaternion& body() const { return body_; }
  const Quaternion& mount() const { return mount_; }
  const TrackerTraits& tracker() const { return tracker_; }
  double size() const { return size_; }   // factor of all lengths
  double tempo() const { return time_; }  // factor of all durations
  double tremor_m() const { return tremor_m_; }
  // Share of takes after which the hand goes back at once, and the speed of that return as a share
  // of the stroke's speed.
  double returns() const { return returns_; }
  double return_speed() const { return return_speed_; }

 private:
  struct Habit;
  Habit habitOf(const MovingGesture& gesture) const;
  // vary() draws a random factor for one take, stray() a random offset; for the average person they
  // return 1 and 0.
  double vary(double deviation, Random& random) const;
  double stray(double deviation, Random& random) const;
  void goRound(Move& circle, const MovingGesture& gesture, const Habit& habit, double size,
               Random& random) const;
  void goAlong(Move& stroke, const MovingGesture& gesture, const Habit& habit, double size,
               Random& random) const;

  MoverSettings settings_;
  std::uint64_t seed_;
  double size_ = 1, time_ = 1, tremor_m_ = 0.0004, returns_ = 0.3, return_speed_ = 0.6;
  Quaternion body_{1, 0, 0, 0}, mount_{1, 0, 0, 0};
  TrackerTraits tracker_;
};

}  // namespace merlin::hand
