// Measures calls that take some hundred nanoseconds.
#pragma once

#include <algorithm>
#include <cstddef>

#include "daemon/base/clock.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

// Returns the time of one call of f(n) [ns]: the minimum of many rounds, so that interruptions do
// not count.
template <typename F>
Measured nanoseconds(F f) {
  constexpr int kCalls = 2000, kRounds = 500;
  const SystemClock clock;
  double least = 1e9;
  for (int r = 0; r < kRounds; ++r) {
    const Timestamp began = clock.now();
    for (int n = 0; n < kCalls; ++n) f(static_cast<std::size_t>(n));
    least = std::min(least, 1e9 * toSeconds(clock.now() - began) / kCalls);
  }
  return Measured::of(least, std::uint64_t{kCalls} * kRounds, "calls");
}

}  // namespace merlin::bench
