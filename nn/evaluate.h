// How good a network is on labelled hands: what is taken for what, how sure it is, and what the
// simplest classifiers make of the same hands. Pure.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "nn/data_set.h"

namespace merlin::nn {

struct Confusion {
  std::string shown, taken_for;  // taken_for is empty: no posture
  std::size_t hands = 0;
};

struct PostureScore {
  std::string posture;
  Score score;
  double least_margin = 1, mean_margin = 0;  // over the hands that were named right; 0..1
};

struct Evaluation {
  Score all;
  std::size_t unsure = 0;  // below the margin asked, right or wrong
  std::size_t right_and_sure = 0;
  std::vector<PostureScore> postures;  // the worst first
  std::vector<Confusion> confusions;   // the most frequent first
};
Evaluation evaluate(const PostureNetwork& network, std::span<const LabelledHand> hands,
                    double least_margin);

// Share of `test` named right by the nearest mean of `train`'s postures, and by the nearest hand of
// it: distances over slots scaled by `train`'s ranges. Cost: train x test.
struct Neighbours {
  double mean = 0, nearest = 0;
};
Neighbours neighbours(std::span<const LabelledHand> train, std::span<const LabelledHand> test);

// Two postures that are hard to tell apart: their means are nearer than `kNearPostures` standard
// deviations of their hands, or hands of one are nearer to the other's mean.
inline constexpr double kNearPostures = 4.0;
struct Overlap {
  std::string first, second;
  double deviations = 0;     // between their means
  std::size_t mixed_up = 0;  // hands of either that are nearer to the other
};
// Those of `posture` with any other; the nearest first. Empty where it has no hands.
std::vector<Overlap> overlapsOf(const std::string& posture, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
