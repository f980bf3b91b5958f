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
  std::string shown, taken_for;  // taken_for is empty for no posture
  std::size_t hands = 0;
};

struct PostureScore {
  std::string posture;
  Score score;
  double least_margin = 1, mean_margin = 0;  // over the hands that were recognised correctly; 0..1
};

struct Evaluation {
  Score all;
  std::size_t unsure = 0;  // hands with a margin below the least one, right or wrong
  std::size_t right_and_sure = 0;
  std::vector<PostureScore> postures;  // the worst first
  std::vector<Confusion> confusions;   // the most frequent first
};
Evaluation evaluate(const PostureNetwork& network, std::span<const LabelledHand> hands,
                    double least_margin);
// The same for a follower, which is shown the hands in the order given.
Evaluation evaluate(DriftFollower& follower, std::span<const LabelledHand> hands,
                    double least_margin);

// Shares of `test` that two classifiers recognise correctly: the nearest mean of a posture of
// `train`, and the nearest hand of `train`. Distances are over slots scaled by `train`'s ranges.
// Cost: train x test.
struct Neighbours {
  double mean = 0, nearest = 0;
};
Neighbours neighbours(std::span<const LabelledHand> train, std::span<const LabelledHand> test);

// Two postures that are hard to tell apart: their means are less than `kNearPostures` standard
// deviations apart, or hands of one are nearer to the mean of the other.
inline constexpr double kNearPostures = 4.0;
struct Overlap {
  std::string first, second;
  double deviations = 0;     // standard deviations between their means
  std::size_t mixed_up = 0;  // hands that are nearer to the mean of the other posture
};
// Returns the pairs of `posture` with another posture, nearest first. Empty if it has no hands.
std::vector<Overlap> overlapsOf(const std::string& posture, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
