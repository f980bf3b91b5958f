// Assigns codes to postures. The assignment decides how hard the five outputs are to train. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/random.h"
#include "nn/postures.h"

namespace merlin::nn {

inline constexpr std::size_t kEvenCodes = 16;  // of even parity: at least two bits apart

// Returns the codes from which `postures` postures get theirs. If codes of even parity suffice,
// only those are returned: one wrong output then gives no posture and never another one. 00000, the
// answer of an untrained network, is left out if there are enough other codes.
enum class Parity { kAny, kEven };
std::vector<std::uint32_t> codesFor(std::size_t postures, Parity parity);

using Likeness = std::vector<std::vector<double>>;  // symmetric, K x K, the diagonal unused

// Chooses one code of `pool` for each of K postures. Similar postures get codes that differ in few
// bits, so that few outputs have to tell them apart and every output has few fine distinctions to
// make. Minimises sum_ij likeness_ij * bits(code_i ^ code_j) by exchanging codes, from `restarts`
// random assignments, and returns the best result.
//
// REQUIRES: K <= pool.size(). Cost: a few ms for 31 postures and 5 restarts.
std::vector<std::uint32_t> assignCodes(const Likeness& likeness,
                                       const std::vector<std::uint32_t>& pool, int restarts,
                                       Random& random);

// Exchanges codes of two postures if the outputs of a partly trained network are nearer to the
// exchanged codes. `mean[k]`: its outputs, averaged over posture k's hands. Returns whether any
// code changed.
bool exchangeCodes(const std::vector<std::array<double, kOutputs>>& mean,
                   const std::vector<std::uint32_t>& pool, std::vector<std::uint32_t>& codes);

}  // namespace merlin::nn
