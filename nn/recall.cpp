#include "nn/recall.h"

#include <algorithm>
#include <array>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "nn/phi.h"

namespace merlin::nn {
namespace {

// Adds up even inputs (with the bias) and odd inputs of a node separately, so that the two chains
// of additions run in parallel.
constexpr std::size_t kApart = 2;

typedef double Pair __attribute__((vector_size(16), may_alias));

// The biases are in the row after the last input.
template <std::size_t Rows, std::size_t Width>
void sumRows(const double* w, const float* x, float* sums) noexcept {
  constexpr std::size_t kPairs = Width / 2;
  const auto* bias = reinterpret_cast<const Pair*>(w + Rows * Width);
  Pair all[kPairs];
  for (std::size_t a = 0; a < kApart; ++a) {
    Pair sum[kPairs] = {};
    if (a == 0) std::copy_n(bias, kPairs, sum);
    for (std::size_t i = a; i < Rows; i += kApart) {
      const auto* row = reinterpret_cast<const Pair*>(w + i * Width);
#pragma GCC unroll 8
      for (std::size_t v = 0; v < kPairs; ++v) sum[v] += row[v] * static_cast<double>(x[i]);
    }
    for (std::size_t v = 0; v < kPairs; ++v) all[v] = a == 0 ? sum[v] : all[v] + sum[v];
  }
  const auto* sum = reinterpret_cast<const double*>(all);
  for (std::size_t j = 0; j < Width; ++j) sums[j] = static_cast<float>(sum[j]);
}

void pass(Phi phi, const Lanes<double>& lanes, const float* x, LanePass<float>& b) noexcept {
  sumRows<kInputs, kHiddenLanes>(lanes.hidden(0), x, b.hidden_sum.data());
  activate<float, kHiddenLanes>(phi, b.hidden_sum.data(), b.hidden.data());
  sumRows<kHidden, kOutputLanes>(lanes.output(0), b.hidden.data(), b.output_sum.data());
  activate<float, kOutputLanes>(phi, b.output_sum.data(), b.output.data());
}

#if defined(__x86_64__)
// Processes four nodes at a time with fused multiply-add.
template <std::size_t Rows, std::size_t Width>
[[gnu::target("avx2,fma"), gnu::always_inline]] inline void sumRowsWide(const double* w,
                                                                        const double* x,
                                                                        float* sums) noexcept {
  constexpr std::size_t kFours = Width / 4;
  __m256d sum[kApart][kFours];
#pragma GCC unroll 4
  for (std::size_t v = 0; v < kFours; ++v) {
    sum[0][v] = _mm256_load_pd(w + Rows * Width + 4 * v);
    sum[1][v] = _mm256_setzero_pd();
  }
#pragma GCC unroll 24
  for (std::size_t i = 0; i < Rows; ++i) {
#pragma GCC unroll 4
    for (std::size_t v = 0; v < kFours; ++v) {
      const __m256d row = _mm256_load_pd(w + i * Width + 4 * v);
      sum[i % kApart][v] = _mm256_fmadd_pd(row, _mm256_broadcast_sd(x + i), sum[i % kApart][v]);
    }
  }
#pragma GCC unroll 2
  for (std::size_t v = 0; v < kFours; v += 2) {
    const __m128 low = _mm256_cvtpd_ps(sum[0][v] + sum[1][v]);
    const __m128 high = _mm256_cvtpd_ps(sum[0][v + 1] + sum[1][v + 1]);
    _mm256_store_ps(sums + 4 * v, _mm256_set_m128(high, low));
  }
}

// Converts the inputs to double once for all nodes.
template <std::size_t N>
[[gnu::target("avx2,fma"), gnu::always_inline]] inline void widen(const float* x,
                                                                  double* wide) noexcept {
  constexpr std::size_t kWhole = N / 4 * 4;
#pragma GCC unroll 6
  for (std::size_t i = 0; i < kWhole; i += 4)
    _mm256_store_pd(wide + i, _mm256_cvtps_pd(_mm_loadu_ps(x + i)));
#pragma GCC unroll 3
  for (std::size_t i = kWhole; i < N; ++i) wide[i] = static_cast<double>(x[i]);
}

[[gnu::target("avx2,fma")]] void passWide(Phi phi, const Lanes<double>& lanes, const float* x,
                                          LanePass<float>& b) noexcept {
  alignas(32) std::array<double, kInputs + 1> wide;  // NOLINT: filled by widen
  widen<kInputs>(x, wide.data());
  sumRowsWide<kInputs, kHiddenLanes>(lanes.hidden(0), wide.data(), b.hidden_sum.data());
  activate<float, kHiddenLanes, 32>(phi, b.hidden_sum.data(), b.hidden.data());
  widen<kHiddenLanes>(b.hidden.data(), wide.data());
  sumRowsWide<kHidden, kOutputLanes>(lanes.output(0), wide.data(), b.output_sum.data());
  activate<float, kOutputLanes, 32>(phi, b.output_sum.data(), b.output.data());
}

bool hasWide() noexcept { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#else
bool hasWide() noexcept { return false; }
void passWide(Phi, const Lanes<double>&, const float*, LanePass<float>&) noexcept {}
#endif

Output outputsOf(const LanePass<float>& b) noexcept {
  Output output;  // NOLINT: filled next
  std::copy_n(b.output.begin(), kOutputs, output.begin());
  return output;
}

}  // namespace

Recall::Recall(Phi phi, const Weights& weights) noexcept : phi_(phi) {
  const Lanes<float> lanes = toLanes(weights);
  std::copy(lanes.all.begin(), lanes.all.end(), lanes_.all.begin());
}

Output Recall::operator()(const Input& x) const noexcept {
  if (!hasWide()) return portably(x);
  LanePass<float> b;  // NOLINT: filled by passWide
  passWide(phi_, lanes_, x.data(), b);
  return outputsOf(b);
}

Output Recall::portably(const Input& x) const noexcept {
  LanePass<float> b;  // NOLINT: filled by pass
  pass(phi_, lanes_, x.data(), b);
  return outputsOf(b);
}

}  // namespace merlin::nn
