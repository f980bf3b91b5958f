// Evaluates a network on labelled hands: accuracy, confusions and margins, and the accuracy of the
// simplest classifiers on the same hands. Pure.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "nn/data_set.h"
#include "nn/drift.h"

namespace merlin::nn {

struct Confusion {
  std::string shown, taken_for;  // taken_for is empty if no posture was recognised
  std::size_t hands = 0;
};

struct PostureScore {
  std::string posture;
  Score score;
  double least_margin = 1, mean_margin = 0;  // of the correctly recognised hands; 0..1
};

struct Evaluation {
  Score all;
  std::size_t unsure = 0;  // hands with a margin below `least_margin`, whether right or wrong
  std::size_t right_and_sure = 0;
  std::vector<PostureScore> postures;  // lowest accuracy first
  std::vector<Confusion> confusions;   // the most frequent first
};
// Recognises every hand with `network` and compares the results with the labels. `least_margin`:
// margin from which a hand counts as sure, 0..1.
Evaluation evaluate(const PostureNetwork& network, std::span<const LabelledHand> hands,
                    double least_margin);
// Recognises every hand with `follower`, in the order given, and compares the results with the
// labels. The follower learns the drift from these hands.
Evaluation evaluate(DriftFollower& follower, std::span<const LabelledHand> hands,
                    double least_margin);

// Shares of the hands of `test` that two simple classifiers recognise correctly, 0..1. `mean` takes
// the posture of `train` whose mean is nearest; `nearest` takes the posture of the nearest hand of
// `train`. Distances are Euclidean, with each slot scaled by its range in `train`. Cost: number of
// hands in `train` times number of hands in `test`.
struct Neighbours {
  double mean = 0, nearest = 0;
};
Neighbours neighbours(std::span<const LabelledHand> train, std::span<const LabelledHand> test);

// Two postures that are hard to tell apart: their means are less than `kNearPostures` standard
// deviations apart, or hands of one are nearer to the mean of the other.
inline constexpr double kNearPostures = 4.0;
struct Overlap {
  std::string first, second;
  double deviations = 0;     // distance of their means, in standard deviations
  std::size_t mixed_up = 0;  // hands that are nearer to the mean of the other posture
};
// Returns the overlaps of `posture` with other postures, nearest first; empty if none of `hands`
// shows `posture`.
std::vector<Overlap> overlapsOf(const std::string& posture, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
