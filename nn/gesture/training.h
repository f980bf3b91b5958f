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
  // A gesture's covariance is a weighted mean of the covariance of its own strokes and the pooled
  // covariance of all gestures. The pooled covariance has the weight of this many strokes, so that
  // a gesture with few strokes depends mainly on it.
  double pooled_strokes = 30;
  double ridge = 0.03;  // least deviation of a feature; its square is added to each variance
  // TrainedGesture::limit is `slack` times the quantile `kept` of the distances of the gesture's
  // own strokes, each measured with a model that was trained without it.
  double kept = 0.995, slack = 1.3;
  // A gesture's lookalikes are the strokes of ordinary motion for which it is the most likely
  // gesture, at a distance of at most `lookalike_reach` times its limit. If a gesture has fewer
  // than `least_lookalikes` of them, no discriminant is trained for it.
  double lookalike_reach = 1.3;
  std::size_t least_lookalikes = 10;
  double decay = 1;  // L2 penalty on the discriminant's weights
  // TrainedGesture::least_odds minimises a loss on strokes held out of the training: 1 for each
  // rejected stroke of the gesture, and `worth` for each accepted lookalike.
  double worth = 0.8;
};

// Trains a model with every gesture named in `strokes`; strokes named kNoGesture are examples of
// ordinary motion. Errors: kInvalidArgument if a name is not valid, there is no gesture or more
// than kMostGestures, or a gesture has fewer than 3 strokes.
Result<GestureModel> trainGestures(std::span<const LabelledStroke> strokes,
                                   const GestureTrainingSettings& settings);

}  // namespace merlin::nn
