// The network's weights laid out for vector instructions: nodes side by side, padded with
// unconnected nodes. One forward pass for recall and training, one gradient. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "nn/network.h"

namespace merlin::nn {

inline constexpr std::size_t kHiddenLanes = 16;  // the last is a constant 1: the outputs' bias
inline constexpr std::size_t kOutputLanes = 8;

template <typename Real>
struct alignas(64) Lanes {
  // One row of kHiddenLanes for each input, then a row of biases; then one row of kOutputLanes for
  // each hidden node, then a row of biases.
  static constexpr std::size_t kOutputs0 = (kInputs + 1) * kHiddenLanes;
  std::array<Real, kOutputs0 + kHiddenLanes * kOutputLanes> all{};

  Real* hidden(std::size_t input) noexcept { return &all[input * kHiddenLanes]; }
  const Real* hidden(std::size_t input) const noexcept { return &all[input * kHiddenLanes]; }
  Real* output(std::size_t node) noexcept { return &all[kOutputs0 + node * kOutputLanes]; }
  const Real* output(std::size_t node) const noexcept {
    return &all[kOutputs0 + node * kOutputLanes];
  }
};

template <typename Real>
Lanes<Real> toLanes(const BasicWeights<Real>& weights) noexcept;
template <typename Real>
BasicWeights<Real> fromLanes(const Lanes<Real>& lanes) noexcept;

template <typename Real>
struct LanePass {
  alignas(64) std::array<Real, kHiddenLanes> hidden_sum, hidden;
  alignas(64) std::array<Real, kOutputLanes> output_sum, output;
};

// The same as propagate() of network.h: each node's sum in the same order, hence the same bits.
template <typename Real>
void propagate(Phi phi, const Lanes<Real>& lanes, const Real* x, LanePass<Real>& pass) noexcept;

// Adds one example's share of the gradient of sum_k (Y_k - T_k)^2 by back-propagation and returns
// that sum. backPropagate() of train.h has an additional factor. REQUIRES: phi not signum.
template <typename Real>
Real addGradient(Phi phi, const Lanes<Real>& lanes, const Real* x, std::uint32_t code,
                 Lanes<Real>& gradient) noexcept;

}  // namespace merlin::nn
