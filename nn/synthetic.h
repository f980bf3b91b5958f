// Synthetic hands: a labelled data set made from hand shapes and noise. Pure, seeded.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "nn/data_set.h"

namespace merlin::nn {

struct HandShape {
  std::string_view name;
  Angles angle_rad{};
};

struct SyntheticSettings {
  std::size_t per_shape = 250;  // hands made of each shape
  InputRanges ranges = kGloveRanges;
  double joint_sigma = 0.08;      // of a joint, share of its span: 0.12 rad where that is 1.5 rad
  double stiffness_sigma = 0.08;  // of the factor by which all joints of one hand bend less or more
  double sensor_sigma = 0.7;      // of a sensor, counts
  int counts = 64;                // of a sensor over its joint's span, >= 1
};

// `per_shape` hands of every shape, all of the first shape first. Of each hand:
//
//   1. every joint's angle times one factor, normal around 1 (a stiff hand, a supple one)
//   2. plus what the joint does alone, normal around 0
//   3. the wrist and slot 7 anywhere in their spans, uniform: no posture may hang on them
//   4. plus the sensor's noise, and rounded to whole counts, as an 8-bit sensor does
//
// Hands on the way from one shape to another are not in it. The rounding also keeps the last bits
// of the machine's log and cos out of the set: one seed, one set.
DataSet makeHands(std::span<const HandShape> shapes, const SyntheticSettings& settings,
                  std::uint64_t seed);

}  // namespace merlin::nn
