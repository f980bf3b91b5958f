// Synthetic people: simulates how different hands hold the same shapes, and how a glove measures
// them. Pure, seeded.
//
// Not measured on real people: README.md explains how the deviations were chosen. Used for
// training, for tests and by the emulator.
#pragma once

#include <array>
#include <cstdint>

#include "daemon/base/random.h"
#include "drivers/hand/shapes.h"

namespace merlin::hand {

using Angles = std::array<float, kGloveSlots>;  // joint angles in slot order [rad]

// Standard deviations. "Share" means: relative to the joint's range of angles, kJointSpans.
struct PeopleSettings {
  double size = 0.04;          // a factor on the bends of all joints of a person
  double joint = 0.03;         // a factor on the bends of a single joint of a person
  double fit = 0.025;          // a sensor's zero, because of the glove's fit, share
  double habit = 0.045;        // a joint in one posture of one person, share
  double take = 0.02;          // a joint each time that the person takes the posture, share
  double wrist = 0.15;         // the wrist each time, share; no posture depends on it
  double tremor = 0.006;       // a joint from sample to sample, share
  double cross_talk = 0.04;    // the part of each neighbour's bend that a sensor measures
  double sensor_counts = 0.6;  // a sensor's noise [raw counts]
};

struct JointSpan {
  float low_rad, high_rad;  // range of angles of the joint
  float rad_per_count;      // resolution of the 8-bit sensor, as in the default calibration
};
extern const std::array<JointSpan, kGloveSlots> kJointSpans;

// One person. Seed 0 is the average person, without habits and with a glove that fits exactly; each
// other seed is a different person, always the same one for the same seed. Reentrant.
class Person {
 public:
  explicit Person(std::uint64_t seed, const PeopleSettings& settings = {});

  // Joint angles with which this person habitually holds `shape`; the habit depends on its name.
  Angles pose(const Shape& shape) const;

  // Like pose(), with the random variation of a single take.
  Angles take(const Shape& shape, Random& random) const;

  // Calibrated output of the glove when this person makes a gesture in which the average person's
  // joints have these angles. Applies the person's factors, tremor, the joints' limits, cross-talk,
  // the glove's fit, noise and quantisation. Slot 7 is 0, because no glove measures it.
  Angles sense(const Angles& joints, Random& random) const;

 private:
  PeopleSettings settings_;
  std::uint64_t seed_;
  Angles bend_{}, fit_rad_{};                             // factor and offset of each slot
  std::array<std::array<float, 2>, kGloveSlots> leak_{};  // cross-talk of the slots beside it
};

}  // namespace merlin::hand
