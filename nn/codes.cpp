#include "nn/codes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>

namespace merlin::nn {
namespace {

// Smaller gains may be rounding errors and could repeat for ever.
constexpr double kLeastGain = 1e-9;

// Returns a permutation of the pool: first the K codes of the postures, then the free ones.
std::vector<std::uint32_t> inUseFirst(const std::vector<std::uint32_t>& pool,
                                      const std::vector<std::uint32_t>& codes) {
  std::vector<std::uint32_t> all = codes;
  for (const std::uint32_t c : pool) {
    if (std::find(codes.begin(), codes.end(), c) == codes.end()) all.push_back(c);
  }
  return all;
}

int bits(std::uint32_t a, std::uint32_t b) { return std::popcount(a ^ b); }

// Returns by how much cost() decreases if postures i and j exchange their codes. An index j from
// the number of postures on stands for a free code.
double gain(const Likeness& likeness, const std::vector<std::uint32_t>& code, std::size_t i,
            std::size_t j) {
  const std::size_t postures = likeness.size();
  double sum = 0;
  for (std::size_t k = 0; k < postures; ++k) {
    if (k == i || k == j) continue;
    const double weight = likeness[i][k] - (j < postures ? likeness[j][k] : 0.0);
    sum += weight * (bits(code[i], code[k]) - bits(code[j], code[k]));
  }
  return sum;
}

double cost(const Likeness& likeness, const std::vector<std::uint32_t>& code) {
  double sum = 0;
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) sum += likeness[i][j] * bits(code[i], code[j]);
  }
  return sum;
}

// Exchanges each of the first `postures` codes with any other code, until no exchange has a gain.
// Returns whether any code was exchanged.
template <typename Gain>
bool exchange(std::vector<std::uint32_t>& code, std::size_t postures, Gain gain) {
  bool any = false;
  for (bool found = true; found; any |= found) {
    found = false;
    for (std::size_t i = 0; i < postures; ++i) {
      for (std::size_t j = i + 1; j < code.size(); ++j) {
        if (gain(code, i, j) < kLeastGain) continue;
        std::swap(code[i], code[j]);
        found = true;
      }
    }
  }
  return any;
}

}  // namespace

std::vector<std::uint32_t> codesFor(std::size_t postures, Parity parity) {
  std::vector<std::uint32_t> pool;
  const bool even = parity == Parity::kEven && postures <= kEvenCodes;
  const std::size_t there = even ? kEvenCodes : kCodes;
  for (std::uint32_t c = postures < there ? 1 : 0; c < kCodes; ++c) {
    if (!even || std::popcount(c) % 2 == 0) pool.push_back(c);
  }
  return pool;
}

std::vector<std::uint32_t> assignCodes(const Likeness& likeness,
                                       const std::vector<std::uint32_t>& pool, int restarts,
                                       Random& random) {
  assert(likeness.size() <= pool.size());
  std::vector<std::uint32_t> best;
  double least = 0;
  for (int r = 0; r < restarts; ++r) {
    auto code = pool;
    for (std::size_t i = code.size() - 1; i > 0; --i) std::swap(code[i], code[random.below(i + 1)]);
    exchange(code, likeness.size(),
             [&](const auto& c, std::size_t i, std::size_t j) { return gain(likeness, c, i, j); });
    code.resize(likeness.size());
    const double c = cost(likeness, code);
    if (best.empty() || c < least) {
      least = c;
      best = std::move(code);
    }
  }
  return best;
}

// The price of a code for a posture is sum_k (o_k - bit_k)^2, where o is the posture's mean output,
// without the terms that are the same for every code.
bool exchangeCodes(const std::vector<std::array<double, kOutputs>>& mean,
                   const std::vector<std::uint32_t>& pool, std::vector<std::uint32_t>& codes) {
  const std::size_t postures = codes.size();
  const auto price = [&](std::size_t posture, std::uint32_t code) {
    double sum = 0;
    for (std::size_t k = 0; posture < postures && k < kOutputs; ++k)
      sum += code >> k & 1 ? 1 - 2 * mean[posture][k] : 0.0;
    return sum;
  };
  auto all = inUseFirst(pool, codes);
  const bool any = exchange(all, postures, [&](const auto& c, std::size_t i, std::size_t j) {
    return price(i, c[i]) + price(j, c[j]) - price(i, c[j]) - price(j, c[i]);
  });
  std::copy_n(all.begin(), postures, codes.begin());
  return any;
}

}  // namespace merlin::nn
