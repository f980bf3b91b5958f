// Assigns five-bit codes to postures. The assignment decides how hard the network's five outputs
// are to train. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "daemon/base/random.h"
#include "nn/postures.h"

namespace merlin::nn {

// Number of codes of even parity. Any two of these codes differ in at least two bits.
inline constexpr std::size_t kEvenCodes = 16;

// Which codes may be used: all 32, or only the 16 of even parity if these suffice.
enum class Parity { kAny, kEven };
// Returns the codes that may be assigned to `postures` postures. With Parity::kEven and at most 16
// postures, these are the codes of even parity: one wrong output then gives no posture and never
// another posture. 00000, the answer of an untrained network, is left out if there are enough other
// codes.
std::vector<std::uint32_t> codesFor(std::size_t postures, Parity parity);

// Similarity of each pair of K postures: a symmetric K x K matrix, whose diagonal is unused.
using Likeness = std::vector<std::vector<double>>;

// Chooses one code of `pool` for each of K postures and returns them in the order of the postures.
// Similar postures get codes that differ in few bits, so that few outputs have to tell them apart
// and every output has few fine distinctions to make. Minimises sum_ij likeness_ij * bits(code_i ^
// code_j), where bits() counts ones, by exchanging codes. This is done from `restarts` random
// assignments, and the best result is returned.
//
// REQUIRES: K <= pool.size(). Cost: a few ms for 31 postures and 5 restarts.
std::vector<std::uint32_t> assignCodes(const Likeness& likeness,
                                       const std::vector<std::uint32_t>& pool, int restarts,
                                       Random& random);

// Adjusts `codes`, one for each posture, to a partly trained network: two postures exchange their
// codes, or one takes a free code of `pool`, wherever the network's outputs are then nearer to the
// codes. `mean[k]`: the network's outputs, averaged over posture k's hands. Returns whether any
// code changed.
bool exchangeCodes(const std::vector<std::array<double, kOutputs>>& mean,
                   const std::vector<std::uint32_t>& pool, std::vector<std::uint32_t>& codes);

}  // namespace merlin::nn
