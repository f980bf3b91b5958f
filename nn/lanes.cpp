#include "nn/lanes.h"

#include "nn/phi.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kBias = kHiddenLanes - 1;
static_assert(kBias == kHidden && kOutputs <= kOutputLanes);

// sums[j] = sum_i w[i][j] x[i], i from 0 up. Keeps each vector of sums in a register, which makes
// the pass four times as fast; g++ 12 does not do so by itself.
template <typename Real, std::size_t Rows, std::size_t Width>
void sumRows(const Real* w, const Real* x, Real* sums) noexcept {
  typedef Real Vector __attribute__((vector_size(16), may_alias));
  constexpr std::size_t kVectors = Width * sizeof(Real) / sizeof(Vector);
  Vector sum[kVectors] = {};
  for (std::size_t i = 0; i < Rows; ++i) {
    const auto* row = reinterpret_cast<const Vector*>(w + i * Width);
#pragma GCC unroll 8
    for (std::size_t v = 0; v < kVectors; ++v) sum[v] += row[v] * x[i];
  }
  auto* out = reinterpret_cast<Vector*>(sums);
#pragma GCC unroll 8
  for (std::size_t v = 0; v < kVectors; ++v) out[v] = sum[v];
}

}  // namespace

template <typename Real>
Lanes<Real> toLanes(const BasicWeights<Real>& weights) noexcept {
  Lanes<Real> lanes;
  for (std::size_t i = 0; i <= kInputs; ++i) {
    for (std::size_t j = 0; j < kHidden; ++j) lanes.hidden(i)[j] = weights.hidden[j][i];
  }
  for (std::size_t j = 0; j <= kHidden; ++j) {
    for (std::size_t k = 0; k < kOutputs; ++k) lanes.output(j)[k] = weights.output[k][j];
  }
  return lanes;
}

template <typename Real>
BasicWeights<Real> fromLanes(const Lanes<Real>& lanes) noexcept {
  BasicWeights<Real> weights;
  for (std::size_t i = 0; i <= kInputs; ++i) {
    for (std::size_t j = 0; j < kHidden; ++j) weights.hidden[j][i] = lanes.hidden(i)[j];
  }
  for (std::size_t j = 0; j <= kHidden; ++j) {
    for (std::size_t k = 0; k < kOutputs; ++k) weights.output[k][j] = lanes.output(j)[k];
  }
  return weights;
}

template <typename Real>
void propagate(Phi phi, const Lanes<Real>& lanes, const Real* x, LanePass<Real>& pass) noexcept {
  sumRows<Real, kInputs, kHiddenLanes>(lanes.hidden(0), x, pass.hidden_sum.data());
  const Real* bias = lanes.hidden(kInputs);
  for (std::size_t j = 0; j < kHiddenLanes; ++j) pass.hidden_sum[j] += bias[j];
  activate<Real, kHiddenLanes>(phi, pass.hidden_sum.data(), pass.hidden.data());
  pass.hidden[kBias] = 1;

  sumRows<Real, kHidden + 1, kOutputLanes>(lanes.output(0), pass.hidden.data(),
                                           pass.output_sum.data());
  activate<Real, kOutputLanes>(phi, pass.output_sum.data(), pass.output.data());
}

template <typename Real>
Real addGradient(Phi phi, const Lanes<Real>& lanes, const Real* x, std::uint32_t code,
                 Lanes<Real>& gradient) noexcept {
  LanePass<Real> pass;
  propagate(phi, lanes, x, pass);
  Real error = 0;
  std::array<Real, kOutputLanes> delta{};
  for (std::size_t k = 0; k < kOutputs; ++k) {
    const Real e = pass.output[k] - static_cast<Real>(code >> k & 1);
    error += e * e;
    delta[k] = 2 * e * slopeOf(phi, pass.output_sum[k], pass.output[k]);
  }
  std::array<Real, kHiddenLanes> back{};
  for (std::size_t j = 0; j < kHidden; ++j) {
    Real sum = 0;
    for (std::size_t k = 0; k < kOutputs; ++k) sum += delta[k] * lanes.output(j)[k];
    back[j] = sum * slopeOf(phi, pass.hidden_sum[j], pass.hidden[j]);
  }
  for (std::size_t j = 0; j <= kBias; ++j) {
    Real* g = gradient.output(j);
    for (std::size_t k = 0; k < kOutputLanes; ++k) g[k] += pass.hidden[j] * delta[k];
  }
  for (std::size_t i = 0; i < kInputs; ++i) {
    Real* g = gradient.hidden(i);
    for (std::size_t j = 0; j < kHiddenLanes; ++j) g[j] += x[i] * back[j];
  }
  Real* bias = gradient.hidden(kInputs);
  for (std::size_t j = 0; j < kHiddenLanes; ++j) bias[j] += back[j];
  return error;
}

template Lanes<float> toLanes(const BasicWeights<float>&) noexcept;
template Lanes<double> toLanes(const BasicWeights<double>&) noexcept;
template BasicWeights<float> fromLanes(const Lanes<float>&) noexcept;
template BasicWeights<double> fromLanes(const Lanes<double>&) noexcept;
template void propagate(Phi, const Lanes<float>&, const float*, LanePass<float>&) noexcept;
template void propagate(Phi, const Lanes<double>&, const double*, LanePass<double>&) noexcept;
template float addGradient(Phi, const Lanes<float>&, const float*, std::uint32_t,
                           Lanes<float>&) noexcept;
template double addGradient(Phi, const Lanes<double>&, const double*, std::uint32_t,
                            Lanes<double>&) noexcept;

}  // namespace merlin::nn
