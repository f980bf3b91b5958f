#include "nn/packed_weights.h"

#include "daemon/base/simd.h"
#include "nn/phi.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kBias = kHiddenWidth - 1;
static_assert(kBias == kHidden && kOutputs <= kOutputWidth);

// Computes sums[j] = sum_i w[i][j] x[i], with i from 0 upwards. The code keeps each vector of sums
// in a register, which makes the pass four times as fast; g++ 12 does not do so by itself.
template <typename Real, std::size_t Rows, std::size_t Width>
void sumRows(const Real* w, const Real* x, Real* sums) noexcept {
  using Reals = simd::Vector<Real, 16>;
  constexpr std::size_t kReals = sizeof(Reals) / sizeof(Real), kVectors = Width / kReals;
  Reals sum[kVectors] = {};
  for (std::size_t i = 0; i < Rows; ++i) {
#pragma GCC unroll 8
    for (std::size_t v = 0; v < kVectors; ++v)
      sum[v] += simd::loadAs<Reals>(w + i * Width + v * kReals) * x[i];
  }
  std::memcpy(sums, sum, sizeof sum);
}

}  // namespace

template <typename Real>
PackedWeights<Real> pack(const BasicWeights<Real>& weights) noexcept {
  PackedWeights<Real> packed;
  for (std::size_t i = 0; i <= kInputs; ++i) {
    for (std::size_t j = 0; j < kHidden; ++j) packed.hidden(i)[j] = weights.hidden[j][i];
  }
  for (std::size_t j = 0; j <= kHidden; ++j) {
    for (std::size_t k = 0; k < kOutputs; ++k) packed.output(j)[k] = weights.output[k][j];
  }
  return packed;
}

template <typename Real>
BasicWeights<Real> unpack(const PackedWeights<Real>& packed) noexcept {
  BasicWeights<Real> weights;
  for (std::size_t i = 0; i <= kInputs; ++i) {
    for (std::size_t j = 0; j < kHidden; ++j) weights.hidden[j][i] = packed.hidden(i)[j];
  }
  for (std::size_t j = 0; j <= kHidden; ++j) {
    for (std::size_t k = 0; k < kOutputs; ++k) weights.output[k][j] = packed.output(j)[k];
  }
  return weights;
}

template <typename Real>
void propagate(Phi phi, const PackedWeights<Real>& packed, const Real* x,
               PackedPass<Real>& pass) noexcept {
  sumRows<Real, kInputs, kHiddenWidth>(packed.hidden(0), x, pass.hidden_sum.data());
  const Real* bias = packed.hidden(kInputs);
  for (std::size_t j = 0; j < kHiddenWidth; ++j) pass.hidden_sum[j] += bias[j];
  activate<Real, kHiddenWidth>(phi, pass.hidden_sum.data(), pass.hidden.data());
  pass.hidden[kBias] = 1;

  sumRows<Real, kHidden + 1, kOutputWidth>(packed.output(0), pass.hidden.data(),
                                           pass.output_sum.data());
  activate<Real, kOutputWidth>(phi, pass.output_sum.data(), pass.output.data());
}

template <typename Real>
Real addGradient(Phi phi, const PackedWeights<Real>& packed, const Real* x, std::uint32_t code,
                 PackedWeights<Real>& gradient) noexcept {
  PackedPass<Real> pass;
  propagate(phi, packed, x, pass);
  Real error = 0;
  std::array<Real, kOutputWidth> delta{};
  for (std::size_t k = 0; k < kOutputs; ++k) {
    const Real e = pass.output[k] - static_cast<Real>(code >> k & 1);
    error += e * e;
    delta[k] = 2 * e * slopeOf(phi, pass.output_sum[k], pass.output[k]);
  }
  std::array<Real, kHiddenWidth> back{};
  for (std::size_t j = 0; j < kHidden; ++j) {
    Real sum = 0;
    for (std::size_t k = 0; k < kOutputs; ++k) sum += delta[k] * packed.output(j)[k];
    back[j] = sum * slopeOf(phi, pass.hidden_sum[j], pass.hidden[j]);
  }
  for (std::size_t j = 0; j <= kBias; ++j) {
    Real* g = gradient.output(j);
    for (std::size_t k = 0; k < kOutputWidth; ++k) g[k] += pass.hidden[j] * delta[k];
  }
  for (std::size_t i = 0; i < kInputs; ++i) {
    Real* g = gradient.hidden(i);
    for (std::size_t j = 0; j < kHiddenWidth; ++j) g[j] += x[i] * back[j];
  }
  Real* bias = gradient.hidden(kInputs);
  for (std::size_t j = 0; j < kHiddenWidth; ++j) bias[j] += back[j];
  return error;
}

template PackedWeights<float> pack(const BasicWeights<float>&) noexcept;
template PackedWeights<double> pack(const BasicWeights<double>&) noexcept;
template BasicWeights<float> unpack(const PackedWeights<float>&) noexcept;
template BasicWeights<double> unpack(const PackedWeights<double>&) noexcept;
template void propagate(Phi, const PackedWeights<float>&, const float*,
                        PackedPass<float>&) noexcept;
template void propagate(Phi, const PackedWeights<double>&, const double*,
                        PackedPass<double>&) noexcept;
template float addGradient(Phi, const PackedWeights<float>&, const float*, std::uint32_t,
                           PackedWeights<float>&) noexcept;
template double addGradient(Phi, const PackedWeights<double>&, const double*, std::uint32_t,
                            PackedWeights<double>&) noexcept;

}  // namespace merlin::nn
