// Adapts a posture network to a new person: trains it further on some of this person's hands and on
// hands drawn from the network's statistics, so that it still recognises other people. Pure; the
// seed is an argument.
#pragma once

#include <span>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/fit.h"

namespace merlin::nn {

struct Adapted {
  PostureNetwork network;
  // Shares of hands that are recognised correctly before and after the adaptation, 0..1. `hands_`:
  // the new person's hands; `drawn_`: hands drawn from the statistics.
  double hands_before = 0, hands_after = 0, drawn_before = 0, drawn_after = 0;
  // Fraction of the trained weight change that is applied, a multiple of 1/8 in 0..1: the smallest
  // with which 99.9 % of the new hands are recognised, but never so much that the recognised share
  // of the drawn hands falls by more than 0.005.
  double share = 1;
};

// Trains `network` further on 100 hands per posture drawn from `statistics` and on half as many
// hands picked at random from `hands`. The postures' codes do not change. Errors: kInvalidArgument
// if a hand's posture is not in `statistics`, a value is not finite or there are no hands. Cost:
// about 0.3 s for 31 postures of 200 hands.
Result<Adapted> adapt(const PostureNetwork& network, const PostureStatistics& statistics,
                      std::span<const LabelledHand> hands, std::uint64_t seed);

}  // namespace merlin::nn
