#include "nn/recall.h"

#include <algorithm>

#include "daemon/base/simd.h"
#include "nn/phi.h"

namespace merlin::nn {
namespace {

// Number of partial sums of a node: even inputs (with the bias) and odd inputs are added
// separately, so that the two chains of additions run in parallel.
constexpr std::size_t kApart = 2;

MERLIN_INLINE auto join(const simd::Vector<float, 8>& a, const simd::Vector<float, 8>& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
MERLIN_INLINE auto join(const simd::Vector<float, 16>& a, const simd::Vector<float, 16>& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Computes the sums of a layer's `width` nodes from `rows` inputs, in vectors of `bytes` bytes. The
// biases are in the row of weights after the last input.
template <std::size_t bytes, std::size_t rows, std::size_t width>
MERLIN_INLINE void sumRows(const double* w, const float* x, float* sums) noexcept {
  using Doubles = simd::Vector<double, bytes>;
  using Singles = simd::Vector<float, bytes / 2>;
  constexpr std::size_t kNodes = bytes / sizeof(double), kVectors = width / kNodes;
  Doubles sum[kApart][kVectors] = {};
#pragma GCC unroll 8
  for (std::size_t v = 0; v < kVectors; ++v)
    sum[0][v] = simd::loadAs<Doubles>(w + rows * width + kNodes * v);
#pragma GCC unroll 24
  for (std::size_t i = 0; i < rows; ++i) {
    Doubles(&to)[kVectors] = sum[i % kApart];
#pragma GCC unroll 8
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto row = simd::loadAs<Doubles>(w + i * width + kNodes * v);
      to[v] = simd::addExact(to[v], row, static_cast<double>(x[i]));
    }
  }
#pragma GCC unroll 4
  for (std::size_t v = 0; v < kVectors; v += 2) {
    const Singles low = __builtin_convertvector(sum[0][v] + sum[1][v], Singles);
    const Singles high = __builtin_convertvector(sum[0][v + 1] + sum[1][v + 1], Singles);
    const auto both = join(low, high);
    std::memcpy(sums + kNodes * v, &both, sizeof both);
  }
}

template <std::size_t bytes>
MERLIN_INLINE void pass(Phi phi, const PackedWeights<double>& weights, const float* x,
                        PackedPass<float>& b) noexcept {
  sumRows<bytes, kInputs, kHiddenWidth>(weights.hidden(0), x, b.hidden_sum.data());
  activate<float, kHiddenWidth, bytes>(phi, b.hidden_sum.data(), b.hidden.data());
  sumRows<bytes, kHidden, kOutputWidth>(weights.output(0), b.hidden.data(), b.output_sum.data());
  activate<float, kOutputWidth, bytes>(phi, b.output_sum.data(), b.output.data());
}

void passPlain(Phi phi, const PackedWeights<double>& weights, const float* x,
               PackedPass<float>& b) noexcept {
  pass<16>(phi, weights, x, b);
}

MERLIN_WIDE void passWide(Phi phi, const PackedWeights<double>& weights, const float* x,
                          PackedPass<float>& b) noexcept {
  pass<32>(phi, weights, x, b);
}

Output outputsOf(const PackedPass<float>& b) noexcept {
  Output output;  // NOLINT: filled next
  std::copy_n(b.output.begin(), kOutputs, output.begin());
  return output;
}

}  // namespace

Recall::Recall(Phi phi, const Weights& weights) noexcept : phi_(phi) {
  const PackedWeights<float> packed = pack(weights);
  std::copy(packed.all.begin(), packed.all.end(), packed_.all.begin());
}

Output Recall::operator()(const Input& x) const noexcept {
  PackedPass<float> b;  // NOLINT: filled next
  simd::pick(passWide, passPlain)(phi_, packed_, x.data(), b);
  return outputsOf(b);
}

Output Recall::portably(const Input& x) const noexcept {
  PackedPass<float> b;  // NOLINT: filled next
  passPlain(phi_, packed_, x.data(), b);
  return outputsOf(b);
}

}  // namespace merlin::nn
