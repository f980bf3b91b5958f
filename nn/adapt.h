// Adapts a network to a new person: trains it on some hands of theirs and on hands drawn from its
// statistics, so that it still recognises everybody else. Pure, seeded.
#pragma once

#include <span>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/fit.h"

namespace merlin::nn {

struct Adapted {
  PostureNetwork network;
  // Shares recognised correctly: of the new hands, and of hands drawn from the statistics.
  double hands_before = 0, hands_after = 0, drawn_before = 0, drawn_after = 0;
  // The share of the trained change of the weights that is applied, 0..1: no more than the new
  // hands need, and never so much that over 0.5 % of the drawn hands are no longer recognised.
  double share = 1;
};

// Trains `network` further on `hands` and on twice as many hands drawn from `statistics`; the codes
// stay. Errors: kInvalidArgument if a posture is unknown to the network, a value is not finite or
// there are no hands. Cost: about 0.3 s for 31 postures of 200 hands.
Result<Adapted> adapt(const PostureNetwork& network, const PostureStatistics& statistics,
                      std::span<const LabelledHand> hands, std::uint64_t seed);

}  // namespace merlin::nn
