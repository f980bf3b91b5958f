// Synthetic people: how different hands hold the same shapes, and what a glove makes of it. Pure,
// seeded.
//
// Not measured on anybody: README.md says how the spreads were set. Used for training, for tests
// and by the emulator.
#pragma once

#include <array>
#include <cstdint>

#include "daemon/base/random.h"
#include "drivers/hand/shapes.h"

namespace merlin::hand {

using Angles = std::array<float, kGloveSlots>;  // joint angles in slot order [rad]

// Standard deviations. "Share" is of the joint's span, kJointSpans.
struct PeopleSettings {
  double size = 0.04;          // of the factor by which all joints of a person bend more or less
  double joint = 0.03;         // of the same for a single joint
  double fit = 0.025;          // of a sensor's zero: how the glove sits, share
  double habit = 0.045;        // of a joint in one posture of one person, share
  double take = 0.02;          // of a joint each time that the posture is taken again, share
  double wrist = 0.15;         // of the wrist each time, share: no posture hangs on it
  double tremor = 0.006;       // of a joint from sample to sample, share
  double cross_talk = 0.04;    // of what a sensor picks up of each neighbour's bend
  double sensor_counts = 0.6;  // of a sensor's own noise, raw counts
};

struct JointSpan {
  float low_rad, high_rad;  // what a hand can do
  float rad_per_count;      // of the 8-bit sensor, as in the shipped calibration
};
extern const std::array<JointSpan, kGloveSlots> kJointSpans;

// One person. A seed of 0 is the average one, who has no habits and whose glove sits well; any
// other seed is a person of their own, always the same one. Reentrant.
class Person {
 public:
  explicit Person(std::uint64_t seed, const PeopleSettings& settings = {});

  // How this person holds `shape`; habits hang on its name.
  Angles pose(const Shape& shape) const;

  // The same, as it comes out this time.
  Angles take(const Shape& shape, Random& random) const;

  // Output of the glove when an average person's joints would be at these angles, after
  // calibration: this person's bends, tremor, the joints' limits, cross-talk, the glove's fit,
  // noise, whole counts. Slot 7 is 0: no glove measures it.
  Angles sense(const Angles& joints, Random& random) const;

 private:
  PeopleSettings settings_;
  std::uint64_t seed_;
  Angles bend_{}, fit_rad_{};                             // factor and offset of each slot
  std::array<std::array<float, 2>, kGloveSlots> leak_{};  // from the slots before and after
};

}  // namespace merlin::hand
