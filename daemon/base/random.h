// Random: a small seeded generator whose numbers are the same on every machine and compiler.
//
// std::mt19937 is portable, but the distributions of <random> are not; MERLIN guarantees the same
// bytes for the same seed. SplitMix64: G. L. Steele et al., "Fast splittable pseudorandom number
// generators", 2014. Not for secrets. Reentrant; an instance is thread-bound.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace merlin {

class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return z ^ z >> 31;
  }

  // Returns a uniformly distributed number in [0, 1).
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }

  // Returns a uniformly distributed number in [0, bound). Its bias, bound / 2^64, is negligible for
  // every use here. REQUIRES: bound > 0.
  std::uint64_t below(std::uint64_t bound) noexcept { return next() % bound; }

  // Returns a normally distributed number with mean 0 and standard deviation 1 (Box-Muller; the
  // second number of the pair is not used).
  double normal() noexcept {
    const double r = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return r * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace merlin
