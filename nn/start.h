// Computes initial weights: a few hyperplanes for each output, which already separate the postures.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/random.h"
#include "nn/packed_weights.h"

namespace merlin::nn {

// Sets three hidden nodes for each output, one after the other, by weighted least squares between
// the postures' means in whitened coordinates. For each further node, a posture that is still on
// the wrong side gets more weight (boosting, Freund and Schapire 1997). An output's weights for the
// nodes of other outputs are small and random. `means` and `codes`: one for each posture. `sigma`:
// standard deviation of a posture's hands in each coordinate.
PackedWeights<float> startingWeights(std::span<const Input> means,
                                     std::span<const std::uint32_t> codes, float sigma,
                                     Random& random);

}  // namespace merlin::nn
