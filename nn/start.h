// Weights to start from: hyperplanes that already tell the postures apart, a few for each output.
#pragma once

#include <span>
#include <vector>

#include "daemon/base/random.h"
#include "nn/lanes.h"

namespace merlin::nn {

// Three hidden nodes for each output, found one after the other by weighted least squares between
// the postures' means (in the space of training; a posture that is still on the wrong side weighs
// more: boosting, Freund and Schapire 1997); small random weights everywhere else.
// `sigma`: how far a posture's hands stray.
Lanes<float> startingWeights(std::span<const Input> means, std::span<const std::uint32_t> codes,
                             float sigma, Random& random);

}  // namespace merlin::nn
