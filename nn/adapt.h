// A new person: a network learns some hands of theirs, and rehearses what it knows from its memory,
// so that nobody else is forgotten. Pure, seeded.
#pragma once

#include <span>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/fit.h"

namespace merlin::nn {

struct Adapted {
  PostureNetwork network;
  // Shares right of the new hands, and of hands drawn from the memory.
  double hands_before = 0, hands_after = 0, memory_before = 0, memory_after = 0;
  // How far the weights went of the way that training asked for, 0..1: no further than the new
  // hands need, and never so far that more than one remembered hand in two hundred is forgotten.
  double share = 1;
};

// `network` is trained further on `hands` and on twice as many drawn from `memory`, with the codes
// it has. errors: kInvalidArgument: a posture that the network does not know, a value that is not
// finite, no hands. cost: about 0.3 s for 31 postures of 200 hands.
Result<Adapted> adapt(const PostureNetwork& network, const Memory& memory,
                      std::span<const LabelledHand> hands, std::uint64_t seed);

}  // namespace merlin::nn
