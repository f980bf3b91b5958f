// Training of gestures from labelled strokes. Pure, deterministic.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "nn/gesture/recogniser.h"

namespace merlin::nn {

struct LabelledStroke {
  std::string gesture;  // kNoGesture: nobody meant any
  StrokeFeatures features{};
};

struct GestureTrainingSettings {
  // Covariance of a gesture = its own strokes' and that of all gestures, which counts as much as
  // this many strokes: the fewer examples, the more alike the gestures' covariances.
  double pooled_strokes = 30;
  double ridge = 0.03;  // least deviation of a feature, added to each
  // The limit of the distance: that of this share of a gesture's own strokes, held out of the
  // training, times `slack`.
  double kept = 0.995, slack = 1.3;
  // Strokes of ordinary motion that are nearest to a gesture, up to its limit times this, are its
  // lookalikes; from fewer than `least_lookalikes` of them no discriminant is made.
  double lookalike_reach = 1.3;
  std::size_t least_lookalikes = 10;
  double decay = 1;  // of the discriminant's weights
  // The least odds lose as few as possible: a gesture's own strokes, and this much for each
  // lookalike that they let through, all held out of the training.
  double worth = 0.8;
};

// Errors: kInvalidArgument: a name is not valid; no gesture or more than kMostGestures; a gesture
// has fewer than 3 strokes.
Result<GestureModel> trainGestures(std::span<const LabelledStroke> strokes,
                                   const GestureTrainingSettings& settings);

}  // namespace merlin::nn
