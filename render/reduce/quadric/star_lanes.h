// SIMD helpers that process eight vertices or triangles of a star at a time. Private to
// render/reduce.
#pragma once

#include <cstdint>
#include <cstring>

#include "daemon/base/simd.h"

namespace merlin::render::reduce {

using simd::all, simd::kLane, simd::load, simd::store, simd::sum, simd::sums;
using simd::Floats, simd::Ints;

// Loads `floats` (3 or 4) floats from each of eight addresses and transposes them: a receives the
// first float of each, b the second, and so on. at(k) returns address k; it is a callable, because
// GCC would write an array of addresses to memory.
template <std::size_t floats = 4, typename At>
MERLIN_INLINE void transpose(const At& at, Floats& a, Floats& b, Floats& c, Floats& d) {
  simd::Vector<float, 16> q[8] = {};
  for (int k = 0; k < 8; ++k) std::memcpy(&q[k], at(k), floats * sizeof(float));
  const Floats r0 = __builtin_shufflevector(q[0], q[4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Floats r1 = __builtin_shufflevector(q[1], q[5], 0, 1, 2, 3, 4, 5, 6, 7);
  const Floats r2 = __builtin_shufflevector(q[2], q[6], 0, 1, 2, 3, 4, 5, 6, 7);
  const Floats r3 = __builtin_shufflevector(q[3], q[7], 0, 1, 2, 3, 4, 5, 6, 7);
  const Floats t0 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13);
  const Floats t1 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15);
  const Floats t2 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13);
  const Floats t3 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
}

// Rotates the lanes: each receives the value of the next lane, and the eighth the value of the
// first.
template <typename T>
MERLIN_INLINE T next(const T& v) {
  return __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 0);
}

// Replaces all lanes from index `count` on by the first lane.
MERLIN_INLINE Ints upTo(std::uint32_t count, const Ints& v) {
  const Ints first = __builtin_shufflevector(v, v, 0, 0, 0, 0, 0, 0, 0, 0);
  return kLane < static_cast<std::int32_t>(count) ? v : first;
}

// firsts() and seconds() return the first and the second numbers of eight pairs. Pairs from index
// `count` on are replaced by the first pair.
MERLIN_INLINE Ints firsts(const std::uint32_t* pairs, std::uint32_t count) {
  return upTo(count,
              __builtin_shufflevector(load(pairs), load(pairs + 8), 0, 2, 4, 6, 8, 10, 12, 14));
}
MERLIN_INLINE Ints seconds(const std::uint32_t* pairs, std::uint32_t count) {
  return upTo(count,
              __builtin_shufflevector(load(pairs), load(pairs + 8), 1, 3, 5, 7, 9, 11, 13, 15));
}

}  // namespace merlin::render::reduce
