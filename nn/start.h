// Initial weights: a few hyperplanes for each output that already separate the postures.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/random.h"
#include "nn/packed_weights.h"

namespace merlin::nn {

// Sets three hidden nodes for each output, one after the other, by weighted least squares between
// the postures' means in whitened coordinates. A posture that is still on the wrong side gets more
// weight (boosting, Freund and Schapire 1997). All other weights are small and random.
// `sigma`: standard deviation of a posture's hands.
PackedWeights<float> startingWeights(std::span<const Input> means,
                                     std::span<const std::uint32_t> codes, float sigma,
                                     Random& random);

}  // namespace merlin::nn
