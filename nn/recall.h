// Recall: the fast forward pass for the glove's device thread. Pure.
#pragma once

#include "nn/network.h"
#include "nn/packed_weights.h"

namespace merlin::nn {

// Immutable, hence thread-safe. Holds 4 kB of weights, laid out for vector instructions.
class Recall {
 public:
  Recall(Phi phi, const Weights& weights) noexcept;

  // Returns the outputs of propagate() of network.h, within 1e-6 of a pass in double.
  // Allocation-free.
  //
  // Sums are computed in double, Phi in float. The product of two floats is exact in a double, so
  // that a fused multiply-add gives the same bits as two instructions, and one hand gives the same
  // outputs on every processor.
  Output operator()(const Input& x) const noexcept;

  // The same bits with baseline instructions only, in twice the time; for tests.
  Output portably(const Input& x) const noexcept;

 private:
  Phi phi_;
  PackedWeights<double> packed_;
};

}  // namespace merlin::nn
