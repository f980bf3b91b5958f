// The network's weights laid out for vector instructions: nodes side by side, padded with
// unconnected nodes. Also the forward pass and the gradient with this layout, as used in training.
// Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "nn/network.h"

namespace merlin::nn {

// The last node is a constant 1, for the outputs' biases.
inline constexpr std::size_t kHiddenWidth = 16;
inline constexpr std::size_t kOutputWidth = 8;

template <typename Real>
struct alignas(64) PackedWeights {
  // One row of kHiddenWidth weights for each input, then a row of biases; then one row of
  // kOutputWidth weights for each hidden node, then a row of biases.
  static constexpr std::size_t kOutputs0 = (kInputs + 1) * kHiddenWidth;
  std::array<Real, kOutputs0 + kHiddenWidth * kOutputWidth> all{};

  Real* hidden(std::size_t input) noexcept { return &all[input * kHiddenWidth]; }
  const Real* hidden(std::size_t input) const noexcept { return &all[input * kHiddenWidth]; }
  Real* output(std::size_t node) noexcept { return &all[kOutputs0 + node * kOutputWidth]; }
  const Real* output(std::size_t node) const noexcept {
    return &all[kOutputs0 + node * kOutputWidth];
  }
};

template <typename Real>
PackedWeights<Real> pack(const BasicWeights<Real>& weights) noexcept;
template <typename Real>
BasicWeights<Real> unpack(const PackedWeights<Real>& packed) noexcept;

template <typename Real>
struct PackedPass {
  alignas(64) std::array<Real, kHiddenWidth> hidden_sum, hidden;
  alignas(64) std::array<Real, kOutputWidth> output_sum, output;
};

// Computes the same as propagate() of network.h, bit by bit, since each node's sum is added in the
// same order. `x`: kInputs numbers.
template <typename Real>
void propagate(Phi phi, const PackedWeights<Real>& packed, const Real* x,
               PackedPass<Real>& pass) noexcept;

// Adds one example's gradient of sum_k (Y_k - T_k)^2, computed by back-propagation, to `gradient`,
// and returns that sum. `x`: kInputs numbers; T_k is bit k of `code`. backPropagate() of train.h
// has an additional factor 1 / (5 n). REQUIRES: phi not signum.
template <typename Real>
Real addGradient(Phi phi, const PackedWeights<Real>& packed, const Real* x, std::uint32_t code,
                 PackedWeights<Real>& gradient) noexcept;

}  // namespace merlin::nn
