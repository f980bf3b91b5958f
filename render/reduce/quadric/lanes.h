// Operations on eight numbers at a time (SIMD). Private to render/reduce.
//
// Code that uses these operations is one portable source, compiled once for any processor and once
// for the wider registers of newer ones (AVX2). Both versions do the same operations in the same
// order, without fused multiply-add, so the results have the same bits. All functions are inlined
// into the one that is compiled for a processor, so the calling convention that GCC warns about
// (-Wpsabi) is never used.
#pragma once

#include <cstdint>
#include <cstring>

#pragma GCC diagnostic ignored "-Wpsabi"
#define MERLIN_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__)
#define MERLIN_WIDE [[gnu::target("avx2")]]  // for the functions compiled for wider registers
#else
#define MERLIN_WIDE
#endif

namespace merlin::render::reduce {

// Returns `wide`, which was compiled with MERLIN_WIDE, if this processor can run it, else
// `portable`. Both are compiled from the same source.
template <typename Function>
Function forThisProcessor(Function wide, Function portable) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return wide;
#endif
  return portable;
}

using Lanes = float __attribute__((vector_size(32)));
using Mask = std::int32_t __attribute__((vector_size(32)));  // also for vertex numbers
using Quad = float __attribute__((vector_size(16)));

inline constexpr Mask kLane = {0, 1, 2, 3, 4, 5, 6, 7};

MERLIN_INLINE Lanes all(float x) { return Lanes{x, x, x, x, x, x, x, x}; }
MERLIN_INLINE Mask all(std::uint32_t x) { return static_cast<std::int32_t>(x) - Mask{}; }
MERLIN_INLINE Lanes load(const float* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
MERLIN_INLINE Mask load(const std::uint32_t* p) {
  Mask v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
MERLIN_INLINE void store(float* p, const Lanes& v) { std::memcpy(p, &v, sizeof v); }
MERLIN_INLINE void store(std::uint32_t* p, const Mask& v) { std::memcpy(p, &v, sizeof v); }

MERLIN_INLINE float sum(const Lanes& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

MERLIN_INLINE std::int32_t sum(const Mask& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

// Returns the sums of eight vectors, each added in the order of sum().
MERLIN_INLINE Lanes sums(const Lanes (&v)[8]) {
  Lanes half[4];  // {v0 + v4, v1 + v5, v2 + v6, v3 + v7} of two
  for (int k = 0; k < 4; ++k) {
    half[k] = __builtin_shufflevector(v[k], v[k + 4], 0, 1, 2, 3, 8, 9, 10, 11) +
              __builtin_shufflevector(v[k], v[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  Lanes quarter[2];
  for (int k = 0; k < 2; ++k) {
    quarter[k] = __builtin_shufflevector(half[2 * k], half[2 * k + 1], 0, 8, 1, 9, 4, 12, 5, 13) +
                 __builtin_shufflevector(half[2 * k], half[2 * k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  return __builtin_shufflevector(quarter[0], quarter[1], 0, 1, 8, 9, 4, 5, 12, 13) +
         __builtin_shufflevector(quarter[0], quarter[1], 2, 3, 10, 11, 6, 7, 14, 15);
}

// Returns the minimum of all lanes, in every lane.
template <typename T>
MERLIN_INLINE T least(const T& of) {
  T v = of;
  const T a = __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
  v = a < v ? a : v;
  const T b = __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
  v = b < v ? b : v;
  const T c = __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6);
  return c < v ? c : v;
}

MERLIN_INLINE bool any(const Mask& m) {
  using Wide = std::int64_t __attribute__((vector_size(16)));
  using Half = std::int32_t __attribute__((vector_size(16)));
  const Half half =
      __builtin_shufflevector(m, m, 0, 1, 2, 3) | __builtin_shufflevector(m, m, 4, 5, 6, 7);
  const auto wide = reinterpret_cast<Wide>(half);
  return (wide[0] | wide[1]) != 0;
}

// Loads `floats` (3 or 4) floats from each of eight addresses and transposes them: a gets the first
// float of each, b the second, and so on. at(k) returns address k; an array of addresses would be
// written to memory by GCC.
template <std::size_t floats = 4, typename At>
MERLIN_INLINE void gather(const At& at, Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  Quad q[8] = {};
  for (int k = 0; k < 8; ++k) std::memcpy(&q[k], at(k), floats * sizeof(float));
  const Lanes r0 = __builtin_shufflevector(q[0], q[4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r1 = __builtin_shufflevector(q[1], q[5], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r2 = __builtin_shufflevector(q[2], q[6], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes r3 = __builtin_shufflevector(q[3], q[7], 0, 1, 2, 3, 4, 5, 6, 7);
  const Lanes t0 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes t1 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes t2 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes t3 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}

// Rotates the lanes: each gets the value of the next lane, the eighth that of the first.
template <typename T>
MERLIN_INLINE T next(const T& v) {
  return __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 0);
}

// Replaces all lanes from `count` on by the first lane.
MERLIN_INLINE Mask upTo(std::uint32_t count, const Mask& v) {
  return kLane < static_cast<std::int32_t>(count)
             ? v
             : __builtin_shufflevector(v, v, 0, 0, 0, 0, 0, 0, 0, 0);
}

// The first (or the second) numbers of eight pairs; pairs from `count` on repeat the first pair.
MERLIN_INLINE Mask firsts(const std::uint32_t* pairs, std::uint32_t count) {
  return upTo(count,
              __builtin_shufflevector(load(pairs), load(pairs + 8), 0, 2, 4, 6, 8, 10, 12, 14));
}
MERLIN_INLINE Mask seconds(const std::uint32_t* pairs, std::uint32_t count) {
  return upTo(count,
              __builtin_shufflevector(load(pairs), load(pairs + 8), 1, 3, 5, 7, 9, 11, 13, 15));
}

}  // namespace merlin::render::reduce
