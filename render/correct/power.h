// Powers of eight numbers at a time. Private to render/correct.
#pragma once

#include <cstdint>

#include "daemon/base/simd.h"

namespace merlin::render::correct {

// Returns x ^ y for each element x in 0..16 and y in 0.05..4, with a relative error of at most
// 1.5e-4: a step of an 8-bit signal is 25 times as large. 0 if x is 0. The polynomials have the
// least relative error of their degree (Remez).
MERLIN_INLINE simd::Floats power(const simd::Floats& x, float y) {
  constexpr std::int32_t kRootHalf = 0x3F3504F3;  // bits of 0.7071
  constexpr float kLeast = 5e-10F;                // its fourth power is still a normal number
  // x = 2^exponent (1 + f), with f in -0.293..0.414
  const simd::Ints bits = reinterpret_cast<simd::Ints>(simd::greatest(x, simd::all(kLeast)));
  const simd::Ints exponent = (bits - kRootHalf) >> 23;
  const simd::Floats f = reinterpret_cast<simd::Floats>(bits - (exponent << 23)) - 1.0F;
  const simd::Floats log2 =
      simd::toFloats(exponent) +
      f * (1.4425785F +
           f * (-0.72024257F + f * (0.48667595F + f * (-0.39456714F + f * 0.25269739F))));
  // 2^t: in t + kWhole the lowest bits of the mantissa hold t rounded to an integer.
  constexpr float kWhole = 12582912.0F + 127;  // 1.5 * 2^23, and the exponent's bias
  const simd::Floats t = log2 * y, sum = t + kWhole;
  const simd::Floats rest = t - (sum - kWhole);  // -0.5..0.5
  const simd::Floats series =
      0.99992807F + rest * (0.69326099F + rest * (0.24261112F + rest * 0.05517167F));
  const simd::Floats result =
      series * reinterpret_cast<simd::Floats>(reinterpret_cast<simd::Ints>(sum) << 23);
  return x > 0.0F ? result : simd::Floats{};
}

}  // namespace merlin::render::correct
