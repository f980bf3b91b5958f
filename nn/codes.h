// Which posture gets which code: the choice that decides how hard the five outputs have it. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/random.h"
#include "nn/postures.h"

namespace merlin::nn {

inline constexpr std::size_t kEvenCodes = 16;  // of an even number of ones: two bits apart

// The codes that `postures` postures are chosen from: all, or while there are enough of them those
// of even parity (one wrong output is then no posture, never another one). 00000, which a network
// says that has learned nothing, is left out where it can be.
enum class Parity { kAny, kEven };
std::vector<std::uint32_t> codesFor(std::size_t postures, Parity parity);

using Likeness = std::vector<std::vector<double>>;  // symmetric, K x K, the diagonal unused

// One code of `pool` for each of K postures, such that those that look alike have codes that differ
// in few bits: then few outputs have to tell them apart, and every output has few fine
// distinctions to make. Makes sum_ij likeness_ij * bits(code_i ^ code_j) small by exchanges, from
// `restarts` random assignments; the best is kept.
//
// REQUIRES: K <= pool.size(). Cost: a few ms for 31 postures and 5 restarts.
std::vector<std::uint32_t> assignCodes(const Likeness& likeness,
                                       const std::vector<std::uint32_t>& pool, int restarts,
                                       Random& random);

// Exchanges codes where a network that is being trained says already that it would be easier:
// `mean[k]` are its outputs, averaged over posture k's hands. Returns whether any changed.
bool exchangeCodes(const std::vector<std::array<double, kOutputs>>& mean,
                   const std::vector<std::uint32_t>& pool, std::vector<std::uint32_t>& codes);

}  // namespace merlin::nn
