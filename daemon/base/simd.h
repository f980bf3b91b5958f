// Vectors of numbers that one instruction processes (SIMD), and the choice between a function that
// is compiled for any processor and one for the wide registers of newer ones. No other file checks
// which processor this is.
//
// Code that uses these vectors is written once and compiled twice:
//
//   MERLIN_INLINE float work(const float* p) { ... }        // with simd::Floats
//   float workPlain(const float* p) { return work(p); }
//   MERLIN_WIDE float workWide(const float* p) { return work(p); }
//   const auto fastest = simd::pick(workWide, workPlain);
//
// Both do the same operations in the same order, and no multiplication is fused with an addition
// (-ffp-contract=off), so the results have the same bits. All functions here are inlined into the
// one that is compiled for a processor, so the calling convention that GCC warns about (-Wpsabi) is
// never used. Pure. Only the result of pick() depends on the processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>  // for instructions that GCC's vectors do not provide
#endif

#pragma GCC diagnostic ignored "-Wpsabi"
#define MERLIN_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__)
#define MERLIN_WIDE [[gnu::target("avx2,fma")]]  // functions compiled for wide registers
#else
#define MERLIN_WIDE
#endif

namespace merlin::simd {

// Returns `wide`, which was compiled with MERLIN_WIDE, if this processor can run it, else `plain`.
template <typename Function>
Function pick(Function wide, Function plain) noexcept {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return wide;
#endif
  return plain;
}

// A vector of `bytes` bytes. Arithmetic works lane by lane. A comparison of Floats or Ints returns
// an Ints whose lanes have all bits set (true) or none (false).
template <typename Number, std::size_t bytes>
using Vector [[gnu::vector_size(bytes)]] = Number;

using Floats = Vector<float, 32>;
using Ints = Vector<std::int32_t, 32>;  // also for 32-bit numbers without a sign, and for masks

inline constexpr Ints kLane = {0, 1, 2, 3, 4, 5, 6, 7};

MERLIN_INLINE Floats all(float x) { return Floats{x, x, x, x, x, x, x, x}; }
MERLIN_INLINE Ints all(std::int32_t x) { return Ints{x, x, x, x, x, x, x, x}; }
MERLIN_INLINE Ints all(std::uint32_t x) { return all(static_cast<std::int32_t>(x)); }

// Loads or stores a vector at any address.
template <typename V>
MERLIN_INLINE V loadAs(const void* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
MERLIN_INLINE Floats load(const float* p) { return loadAs<Floats>(p); }
MERLIN_INLINE Ints load(const std::int32_t* p) { return loadAs<Ints>(p); }
MERLIN_INLINE Ints load(const std::uint32_t* p) { return loadAs<Ints>(p); }
MERLIN_INLINE Ints load(const std::uint16_t* p) {
  return __builtin_convertvector((loadAs<Vector<std::uint16_t, 16>>(p)), Ints);
}
MERLIN_INLINE void store(float* p, const Floats& v) { std::memcpy(p, &v, sizeof v); }
MERLIN_INLINE void store(std::uint32_t* p, const Ints& v) { std::memcpy(p, &v, sizeof v); }

// Returns sum + a * b. REQUIRES: a double holds each product exactly, as it does for two floats;
// then a fused operation, with one rounding, gives the same bits as two operations. The overload
// for four lanes may be used only in a function with MERLIN_WIDE.
MERLIN_INLINE Vector<double, 16> addExact(const Vector<double, 16>& sum,
                                          const Vector<double, 16>& a, double b) {
  return sum + a * b;
}
MERLIN_INLINE Vector<double, 32> addExact(const Vector<double, 32>& sum,
                                          const Vector<double, 32>& a, double b) {
#if defined(__x86_64__)
  return __builtin_ia32_vfmaddpd256(a, Vector<double, 32>{b, b, b, b}, sum);
#else
  return sum + a * b;
#endif
}

// Returns, lane by lane, from[index] where all bits of `mask` are set; elsewhere it reads nothing
// and returns the lane of `otherwise`. To be used only in functions with MERLIN_WIDE.
MERLIN_WIDE MERLIN_INLINE Ints gather(const std::uint32_t* from, const Ints& index,
                                      const Ints& mask, const Ints& otherwise) {
#if defined(__x86_64__)
  const auto* numbers = reinterpret_cast<const std::int32_t*>(from);
  return reinterpret_cast<Ints>(_mm256_mask_i32gather_epi32(
      reinterpret_cast<__m256i>(otherwise), numbers, reinterpret_cast<__m256i>(index),
      reinterpret_cast<__m256i>(mask), 4));
#else
  Ints v = otherwise;
  for (int k = 0; k < 8; ++k) {
    if (mask[k] != 0) v[k] = static_cast<std::int32_t>(from[index[k]]);
  }
  return v;
#endif
}

// Convert the number in each lane to the other type; toInts() rounds towards zero.
MERLIN_INLINE Floats toFloats(const Ints& v) { return __builtin_convertvector(v, Floats); }
MERLIN_INLINE Ints toInts(const Floats& v) { return __builtin_convertvector(v, Ints); }

// Return, lane by lane, the lesser or the greater value; the value of b if one of them is not a
// number (NaN).
template <typename V>
MERLIN_INLINE V least(const V& a, const V& b) {
  return a < b ? a : b;
}
template <typename V>
MERLIN_INLINE V greatest(const V& a, const V& b) {
  return a > b ? a : b;
}

// Returns the sum of the lanes.
MERLIN_INLINE float sum(const Floats& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}
MERLIN_INLINE std::int32_t sum(const Ints& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// Returns the sums of eight vectors: lane k is sum(v[k]), with the same bits.
MERLIN_INLINE Floats sums(const Floats (&v)[8]) {
  Floats half[4];  // {v0 + v4, v1 + v5, v2 + v6, v3 + v7} of two
  for (int k = 0; k < 4; ++k) {
    half[k] = __builtin_shufflevector(v[k], v[k + 4], 0, 1, 2, 3, 8, 9, 10, 11) +
              __builtin_shufflevector(v[k], v[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  Floats quarter[2];
  for (int k = 0; k < 2; ++k) {
    quarter[k] = __builtin_shufflevector(half[2 * k], half[2 * k + 1], 0, 8, 1, 9, 4, 12, 5, 13) +
                 __builtin_shufflevector(half[2 * k], half[2 * k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  return __builtin_shufflevector(quarter[0], quarter[1], 0, 1, 8, 9, 4, 5, 12, 13) +
         __builtin_shufflevector(quarter[0], quarter[1], 2, 3, 10, 11, 6, 7, 14, 15);
}

// Returns a vector whose lanes all hold the minimum of the lanes.
template <typename V>
MERLIN_INLINE V leastLane(const V& of) {
  V v = of;
  const V a = __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
  v = a < v ? a : v;
  const V b = __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
  v = b < v ? b : v;
  const V c = __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6);
  return c < v ? c : v;
}

// Return true if a bit of any lane is set. anyWide() is faster, but may be used only in functions
// with MERLIN_WIDE.
MERLIN_INLINE bool any(const Ints& mask) {
  const Vector<std::int32_t, 16> half = __builtin_shufflevector(mask, mask, 0, 1, 2, 3) |
                                        __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  const auto two = reinterpret_cast<Vector<std::int64_t, 16>>(half);
  return (two[0] | two[1]) != 0;
}
MERLIN_WIDE MERLIN_INLINE bool anyWide(const Ints& mask) {
#if defined(__x86_64__)
  return _mm256_testz_si256(reinterpret_cast<__m256i>(mask), reinterpret_cast<__m256i>(mask)) == 0;
#else
  return any(mask);
#endif
}

}  // namespace merlin::simd
