// Recall: the forward pass as the glove's device thread runs it. Pure.
#pragma once

#include "nn/lanes.h"
#include "nn/network.h"

namespace merlin::nn {

// Immutable: thread-safe. 4 kB of weights, laid out for vector instructions.
class Recall {
 public:
  Recall(Phi phi, const Weights& weights) noexcept;

  // The outputs of propagate() of network.h, within 1e-6 of a pass in double. Allocation-free.
  //
  // Sums are of doubles, Phi of floats. A product of two floats is exact in a double, so that
  // multiplying and adding in one step gives the same bits as in two, and one hand gives the same
  // outputs whatever vector instructions a processor has.
  Output operator()(const Input& x) const noexcept;

  // With the instructions that every processor has: the same bits, in twice the time.
  Output portably(const Input& x) const noexcept;

 private:
  Phi phi_;
  Lanes<double> lanes_;
};

}  // namespace merlin::nn
