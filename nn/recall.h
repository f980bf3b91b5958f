// Recall: the fast forward pass for the glove's device thread. Pure.
#pragma once

#include "nn/network.h"
#include "nn/packed_weights.h"

namespace merlin::nn {

// Immutable, hence thread-safe. Holds 4 kB of weights, laid out for vector instructions.
class Recall {
 public:
  Recall(Phi phi, const Weights& weights) noexcept;

  // Returns the network's outputs for `x`, within 1e-6 of those of propagate() of network.h in
  // double. Allocation-free.
  //
  // Sums are computed in double, Phi in float. The product of two floats is exact in a double, so
  // that a fused multiply-add gives the same bits as two instructions, and one hand gives the same
  // outputs on every processor.
  Output operator()(const Input& x) const noexcept;

  // Returns the same outputs bit by bit, but uses the processor's baseline instructions only and
  // takes twice the time; for tests.
  Output portably(const Input& x) const noexcept;

 private:
  Phi phi_;
  PackedWeights<double> packed_;
};

}  // namespace merlin::nn
