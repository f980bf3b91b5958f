// The transfer function Phi and its derivative: scalar for doubles, vectorised for floats.
//
// For floats, e^t and atan are polynomials with Cephes' coefficients (S. L. Moshier). Phi is then
// accurate to 2e-7, and unlike with libm its bits are the same on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <type_traits>

#include "daemon/base/simd.h"
#include "nn/network.h"

namespace merlin::nn {

// Computes Phi in place, on vectors of `bytes` bytes, 16 or 32. The vector operations are written
// out, since g++ 12 vectorises these polynomials only in part.
template <std::size_t bytes>
struct PhiVectors {
  using Floats = simd::Vector<float, bytes>;
  using Words = simd::Vector<std::uint32_t, bytes>;

  // Replaces t by e^t. |t| is limited to 87, beyond which a float's Phi is 0 or 1. A NaN stays NaN.
  MERLIN_INLINE static void toExp(Floats& t) noexcept {
    constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it rounds to an integer
    const Floats least = Floats{} - 87.0F, most = Floats{} + 87.0F;
    Floats held = t < least ? least : t;
    held = held > most ? most : held;
    const Floats shifted = held * 1.44269504F + kRound, n = shifted - kRound;
    const Floats r = held - n * 0.693359375F + n * 2.12194440e-4F, r2 = r * r;
    // Estrin's scheme instead of Horner's: shorter chains of dependent instructions.
    const Floats high = r * 1.9875691500e-4F + 1.3981999507e-3F;
    const Floats middle = r * 8.3334519073e-3F + 4.1665795894e-2F;
    const Floats low = r * 1.6666665459e-1F + 5.0000001201e-1F;
    const Floats power = (high * (r2 * r2) + (middle * r2 + low)) * r2 + r + 1.0F;
    // Multiply by 2^n; n is in the low bits of `shifted`, so that a NaN needs no special case.
    const Words bits = (reinterpret_cast<Words>(shifted) - 0x4B400000U + 127U) << 23;
    t = power * reinterpret_cast<Floats>(bits);
  }

  MERLIN_INLINE static void toAtan(Floats& t) noexcept {
    const Floats zero{}, one = zero + 1.0F;
    const Floats a = t < zero ? -t : t;
    const Floats far = zero + 2.414213562F, middle = zero + 0.414213562F;
    const Floats top = a > far ? -one : (a > middle ? a - 1.0F : a);
    const Floats bottom = a > far ? a : (a > middle ? a + 1.0F : one);
    const Floats base = a > far ? zero + 1.570796327F : (a > middle ? zero + 0.785398163F : zero);
    const Floats r = top / bottom, z = r * r;
    Floats p = z * 8.05374449538e-2F - 1.38776856032e-1F;
    p = p * z + 1.99777106478e-1F;
    p = p * z - 3.33329491539e-1F;
    const Floats value = base + (p * z * r + r);
    t = t < zero ? -value : value;
  }

  // Replaces t by Phi(t).
  template <Phi kPhi>
  MERLIN_INLINE static void toPhi(Floats& t) noexcept {
    const Floats zero{}, one = zero + 1.0F;
    if constexpr (kPhi == Phi::kSigmoid) {
      t = -t;
      toExp(t);
      t = 1.0F / (1.0F + t);
    } else if constexpr (kPhi == Phi::kAtan) {
      toAtan(t);
      t = 0.5F + t * std::numbers::inv_pi_v<float>;
    } else {
      t = t == t ? (t > zero ? one : zero)
                 : t;  // keeps a NaN, which a comparison alone would turn into 0
    }
  }

  template <Phi kPhi, std::size_t N>
  MERLIN_INLINE static void activate(const float* sums, float* values) noexcept {
    constexpr std::size_t kAtOnce = bytes / sizeof(float);
    constexpr std::size_t kWhole = N / kAtOnce * kAtOnce, kRest = (N - kWhole) * sizeof(float);
    Floats some{};
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kWhole; i += kAtOnce) {
      std::memcpy(&some, sums + i, sizeof some);
      toPhi<kPhi>(some);
      std::memcpy(values + i, &some, sizeof some);
    }
    if constexpr (kRest > 0) {
      std::memcpy(&some, sums + kWhole, kRest);
      toPhi<kPhi>(some);
      std::memcpy(values + kWhole, &some, kRest);
    }
  }
};

inline float expOf(float t) noexcept {
  PhiVectors<16>::Floats four = {t, t, t, t};
  PhiVectors<16>::toExp(four);
  return four[0];
}

inline double phiOf(Phi phi, double sum) noexcept {
  switch (phi) {
    case Phi::kSigmoid: return 1 / (1 + std::exp(-sum));
    case Phi::kSignum: return std::isnan(sum) ? sum : (sum > 0 ? 1.0 : 0.0);
    case Phi::kAtan: return 0.5 + std::atan(sum) * std::numbers::inv_pi;
  }
  return sum;
}

// Sets values[j] = Phi(sums[j]) for `N` nodes.
template <typename Real, std::size_t N, std::size_t bytes = 16>
MERLIN_INLINE void activate(Phi phi, const Real* sums, Real* values) noexcept {
  if constexpr (std::is_same_v<Real, float>) {
    using V = PhiVectors<bytes>;
    switch (phi) {
      case Phi::kSigmoid: return V::template activate<Phi::kSigmoid, N>(sums, values);
      case Phi::kSignum: return V::template activate<Phi::kSignum, N>(sums, values);
      case Phi::kAtan: return V::template activate<Phi::kAtan, N>(sums, values);
    }
  } else {
    for (std::size_t i = 0; i < N; ++i) values[i] = phiOf(phi, sums[i]);
  }
}

// Returns Phi'(sum), given value = Phi(sum).
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
