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
  std::string gesture;  // kNoGesture: not meant as a gesture
  StrokeFeatures features{};
};

struct GestureTrainingSettings {
  // A gesture's covariance is a weighted mean of its own strokes' and that of all gestures, which
  // has the weight of this many strokes: the fewer examples, the more alike the gestures'
  // covariances.
  double pooled_strokes = 30;
  double ridge = 0.03;  // least deviation of a feature; its square is added to each variance
  // The limit of the distance is the quantile `kept` of the distances of a gesture's own strokes,
  // when held out of the training, times `slack`.
  double kept = 0.995, slack = 1.3;
  // Strokes of ordinary motion that are nearest to a gesture, up to its limit times this, are its
  // lookalikes; if there are fewer than `least_lookalikes` of them, no discriminant is trained.
  double lookalike_reach = 1.3;
  std::size_t least_lookalikes = 10;
  double decay = 1;  // L2 penalty on the discriminant's weights
  // `least_odds` minimises the loss on strokes held out of the training: 1 for each of the
  // gesture's own strokes that it rejects, and this much for each lookalike that it accepts.
  double worth = 0.8;
};

// Errors: kInvalidArgument: a name is not valid; no gesture or more than kMostGestures; a gesture
// has fewer than 3 strokes.
Result<GestureModel> trainGestures(std::span<const LabelledStroke> strokes,
                                   const GestureTrainingSettings& settings);

}  // namespace merlin::nn
