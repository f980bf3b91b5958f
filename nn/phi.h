// Phi and its slope, of doubles one by one, of floats four at a time.
//
// For float, e^t and atan are polynomials of our own (Cephes' coefficients, S. L. Moshier): a
// vector at a time, within 2e-7 of Phi, and the same bits on every machine, which libm's are not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <type_traits>

#include "nn/network.h"

namespace merlin::nn {

// Four at a time: g++ 12 finds the vectors in these polynomials only in part.
typedef float FloatVector __attribute__((vector_size(16), may_alias));
typedef std::uint32_t BitVector __attribute__((vector_size(16), may_alias));

// |t| beyond 87 is taken for 87: past that, Phi is 0 or 1 in a float. A NaN gives a NaN.
inline FloatVector expOf(FloatVector t) noexcept {
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it leaves whole numbers
  const FloatVector least = FloatVector{} - 87.0F, most = FloatVector{} + 87.0F;
  FloatVector held = t < least ? least : t;
  held = held > most ? most : held;
  const FloatVector shifted = held * 1.44269504F + kRound, n = shifted - kRound;
  const FloatVector r = held - n * 0.693359375F + n * 2.12194440e-4F;
  FloatVector p = r * 1.9875691500e-4F + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  const FloatVector power = p * r * r + r + 1.0F;
  // 2^n: n stands in the low bits of `shifted`, so that a NaN needs no case.
  const BitVector bits = ((BitVector)shifted - 0x4B400000U + 127U) << 23;
  return power * (FloatVector)bits;
}

inline float expOf(float t) noexcept { return expOf(FloatVector{t, t, t, t})[0]; }

inline FloatVector atanOf(FloatVector t) noexcept {
  const FloatVector zero{}, one = zero + 1.0F;
  const FloatVector a = t < zero ? -t : t;
  const FloatVector far = zero + 2.414213562F, middle = zero + 0.414213562F;
  const FloatVector top = a > far ? -one : (a > middle ? a - 1.0F : a);
  const FloatVector bottom = a > far ? a : (a > middle ? a + 1.0F : one);
  const FloatVector base =
      a > far ? zero + 1.570796327F : (a > middle ? zero + 0.785398163F : zero);
  const FloatVector r = top / bottom, z = r * r;
  FloatVector p = z * 8.05374449538e-2F - 1.38776856032e-1F;
  p = p * z + 1.99777106478e-1F;
  p = p * z - 3.33329491539e-1F;
  const FloatVector value = base + (p * z * r + r);
  return t < zero ? -value : value;
}

inline double phiOf(Phi phi, double sum) noexcept {
  switch (phi) {
    case Phi::kSigmoid: return 1 / (1 + std::exp(-sum));
    case Phi::kSignum: return std::isnan(sum) ? sum : (sum > 0 ? 1.0 : 0.0);
    case Phi::kAtan: return 0.5 + std::atan(sum) * std::numbers::inv_pi;
  }
  return sum;
}

inline FloatVector phiOf(Phi phi, FloatVector sum) noexcept {
  const FloatVector zero{}, one = zero + 1.0F;
  switch (phi) {
    case Phi::kSigmoid: return 1.0F / (1.0F + expOf(-sum));
    // A comparison alone would make a NaN a clean 0.
    case Phi::kSignum: return sum == sum ? (sum > zero ? one : zero) : sum;
    case Phi::kAtan: return 0.5F + atanOf(sum) * std::numbers::inv_pi_v<float>;
  }
  return sum;
}

// values = Phi(sums), of `N` nodes.
template <typename Real, std::size_t N>
void activate(Phi phi, const Real* sums, Real* values) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    constexpr std::size_t kFours = N / 4 * 4, kRest = (N - kFours) * sizeof(float);
    FloatVector four{};
    for (std::size_t i = 0; i < kFours; i += 4) {
      std::memcpy(&four, sums + i, sizeof four);
      four = phiOf(phi, four);
      std::memcpy(values + i, &four, sizeof four);
    }
    if (kRest == 0) return;
    std::memcpy(&four, sums + kFours, kRest);
    four = phiOf(phi, four);
    std::memcpy(values + kFours, &four, kRest);
  } else {
    for (std::size_t i = 0; i < N; ++i) values[i] = phiOf(phi, sums[i]);
  }
}

// Phi'(sum), where value = Phi(sum).
template <typename Real>
Real slopeOf(Phi phi, Real sum, Real value) noexcept {
  switch (phi) {
    case Phi::kSigmoid: return value * (1 - value);
    case Phi::kSignum: break;
    case Phi::kAtan: return std::numbers::inv_pi_v<Real> / (1 + sum * sum);
  }
  return 0;
}

}  // namespace merlin::nn
