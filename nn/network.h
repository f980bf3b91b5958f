// The posture network: 23 inputs, 15 hidden nodes, 5 outputs, fully connected, feed-forward. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace merlin::nn {

inline constexpr std::size_t kInputs = 23;  // order and ranges: nn/README.md, "Slots"
inline constexpr std::size_t kHidden = 15;
inline constexpr std::size_t kOutputs = 5;  // five bits, thresholded at 0.5: up to 32 postures

using Input = std::array<float, kInputs>;    // each in [0, 1], scaled as in nn/inputs.h
using Output = std::array<float, kOutputs>;  // activations in [0, 1]

// The transfer function of every node. [GOU] A.5.1 names the three; the last two are shifted and
// scaled from (-1, 1) to (0, 1), so that one threshold of 0.5 serves all:
//   sigmoid  1 / (1 + e^-t)
//   signum   1 for t > 0, else 0; it has no slope, so it recalls and cannot be trained
//   atan     1/2 + atan(t) / pi
enum class Phi { kSigmoid, kSignum, kAtan };

const char* nameOf(Phi phi) noexcept;                         // "sigmoid", "signum", "atan"
std::optional<Phi> phiNamed(std::string_view name) noexcept;  // nothing if unknown

// Weights, row-major; the last column of a row is the bias. 15 x 24 and 5 x 16: 440 numbers.
// Real is float for recall, double for training.
template <typename Real>
struct BasicWeights {
  std::array<std::array<Real, kInputs + 1>, kHidden> hidden{};
  std::array<std::array<Real, kHidden + 1>, kOutputs> output{};
};
using Weights = BasicWeights<float>;

// All sums (I_j of [GOU] A.9) and values (Y_j of A.10) of the nodes in one forward pass.
template <typename Real>
struct Pass {
  std::array<Real, kHidden> hidden_sum, hidden;
  std::array<Real, kOutputs> output_sum, output;
};

// The forward pass, from the inputs to the hidden layer and from there to the outputs. A node has
//
//   I_j = sum_i W_ji X_i + bias_j   [GOU] A.9,    Y_j = Phi(I_j)   [GOU] A.10
//
// Pure and allocation-free: it runs in the glove's device thread. Inputs outside [0, 1] are not
// clamped. A NaN among the inputs makes every output NaN, for every Phi. Sums run upwards from
// i = 0, the bias last; floats give the same bits on every machine (phi.h).
template <typename Real>
Pass<Real> propagate(Phi phi, const BasicWeights<Real>& weights,
                     const std::array<Real, kInputs>& x) noexcept;

// Returns only the outputs of propagate().
Output forward(Phi phi, const Weights& weights, const Input& x) noexcept;

// Returns the five-bit code: bit i is set if output i is above 0.5 ([GOU] 2.3), and not set if the
// output is NaN.
std::uint32_t threshold(const Output& output) noexcept;

}  // namespace merlin::nn
