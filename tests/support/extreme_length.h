// Numbers of 32 bits at which a reader's sums of lengths wrap or turn negative, for fuzzing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "daemon/base/random.h"

namespace merlin::test {

// Writes such a number, big-endian or little-endian at random, over the four bytes from `at` on, or
// over as many as remain up to the end. `Bytes`: a string or vector of bytes.
template <typename Bytes>
void writeExtremeLength(Bytes& bytes, std::size_t at, Random& random) {
  constexpr std::uint32_t kLengths[] = {0xFFFFFFFC, 0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0};
  constexpr std::size_t kBytes = 4;
  const std::uint32_t length = kLengths[random.below(std::size(kLengths))];
  const bool big_endian = random.below(2) == 0;
  for (std::size_t i = 0; i < kBytes && at + i < bytes.size(); ++i) {
    const std::size_t shift = 8 * (big_endian ? kBytes - 1 - i : i);
    bytes[at + i] = static_cast<typename Bytes::value_type>(length >> shift & 0xFF);
  }
}

}  // namespace merlin::test
