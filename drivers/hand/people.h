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

// Standard deviations of the quantities named below. "Share": as a share of the joint's range of
// angles, kJointSpans.
struct PeopleSettings {
  double size = 0.04;          // factor of the bends of all joints of a person
  double joint = 0.03;         // factor of the bends of a single joint of a person
  double fit = 0.025;          // zero point of a sensor, due to the glove's fit; share
  double habit = 0.045;        // a joint's angle from person to person in one posture; share
  double take = 0.02;          // a joint's angle from time to time in one posture; share
  double wrist = 0.15;         // a wrist's angle from time to time; share; no posture depends on it
  double tremor = 0.006;       // a joint's angle from sample to sample; share
  double cross_talk = 0.04;    // share of each neighbour's bend that a sensor also measures
  double sensor_counts = 0.6;  // noise of a sensor [raw counts]
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

  // Returns the joint angles with which this person habitually holds `shape`; the habit depends on
  // the shape's name.
  Angles pose(const Shape& shape) const;

  // Returns the angles of pose() with the random variation of a single take.
  Angles take(const Shape& shape, Random& random) const;

  // Returns the calibrated output of the glove when this person holds a posture in which the
  // average person's joints have the angles `joints`. Applies the person's factors, tremor, the
  // joints' limits, cross-talk, the glove's fit, noise and quantisation. Slot 7 is 0, because no
  // glove measures it.
  Angles sense(const Angles& joints, Random& random) const;

 private:
  PeopleSettings settings_;
  std::uint64_t seed_;
  Angles bend_{}, fit_rad_{};                             // factor and offset of each slot
  std::array<std::array<float, 2>, kGloveSlots> leak_{};  // cross-talk from the two slots beside it
};

}  // namespace merlin::hand
