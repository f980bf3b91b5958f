// SIMD vectors of eight pixels. Private to render/correct.
//
// As in render/reduce/quadric/lanes.h, one portable source is compiled once for any CPU and once
// for AVX2, with bit-identical results. All functions are inlined into the function that is
// compiled for a CPU, so the calling convention that GCC warns about (-Wpsabi) is never used.
#pragma once

#include <cstdint>
#include <cstring>

#pragma GCC diagnostic ignored "-Wpsabi"
#define MERLIN_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__)
#define MERLIN_WIDE [[gnu::target("avx2")]]  // marks functions compiled for AVX2
#else
#define MERLIN_WIDE
#endif

namespace merlin::render::correct::lanes {

using Reals = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using Pairs = std::uint64_t __attribute__((vector_size(32)));

MERLIN_INLINE Reals all(float x) { return Reals{x, x, x, x, x, x, x, x}; }
MERLIN_INLINE Ints all(std::int32_t x) { return Ints{x, x, x, x, x, x, x, x}; }

MERLIN_INLINE Ints load(const std::int32_t* p) {
  Ints v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
MERLIN_INLINE Ints load(const std::uint16_t* p) {
  using Shorts = std::uint16_t __attribute__((vector_size(16)));
  Shorts v;
  std::memcpy(&v, p, sizeof v);
  return __builtin_convertvector(v, Ints);
}

MERLIN_INLINE Reals real(const Ints& v) { return __builtin_convertvector(v, Reals); }
MERLIN_INLINE Ints whole(const Reals& v) { return __builtin_convertvector(v, Ints); }

template <typename T>
MERLIN_INLINE T least(const T& a, const T& b) {
  return a < b ? a : b;
}
template <typename T>
MERLIN_INLINE T greatest(const T& a, const T& b) {
  return a > b ? a : b;
}

// x ^ y for x in 0..16 and y in 0.05..4, with a relative error of at most 1.5e-4: a step of an
// 8-bit signal is 25 times as large. 0 if x is 0. The polynomials have the least relative error of
// their degree (Remez).
MERLIN_INLINE Reals power(const Reals& x, float y) {
  constexpr std::int32_t kRootHalf = 0x3F3504F3;  // bits of 0.7071
  constexpr float kLeast = 5e-10F;                // its fourth power is still a normal number
  // x = 2^exponent (1 + f), with f in -0.293..0.414
  const Ints bits = reinterpret_cast<Ints>(greatest(x, all(kLeast)));
  const Ints exponent = (bits - kRootHalf) >> 23;
  const Reals f = reinterpret_cast<Reals>(bits - (exponent << 23)) - 1.0F;
  const Reals log2 =
      real(exponent) +
      f * (1.4425785F +
           f * (-0.72024257F + f * (0.48667595F + f * (-0.39456714F + f * 0.25269739F))));
  // 2^t: in t + kWhole the lowest bits of the mantissa hold t rounded to an integer.
  constexpr float kWhole = 12582912.0F + 127;  // 1.5 * 2^23, and the exponent's bias
  const Reals t = log2 * y, sum = t + kWhole;
  const Reals rest = t - (sum - kWhole);  // -0.5..0.5
  const Reals series =
      0.99992807F + rest * (0.69326099F + rest * (0.24261112F + rest * 0.05517167F));
  const Reals result = series * reinterpret_cast<Reals>(reinterpret_cast<Ints>(sum) << 23);
  return x > 0.0F ? result : Reals{};
}

}  // namespace merlin::render::correct::lanes
