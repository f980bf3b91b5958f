// Decompresses LZF, the compression of binary_compressed PCD files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace merlin::render::range {

// A control byte c below 32 is followed by c + 1 bytes, which are copied to the output. Any other
// has a length in its upper three bits (if it is 7, the next byte is added to it); its lower five
// bits and the next byte are a distance. Then length + 2 bytes are copied from distance + 1 bytes
// back in the output. Returns exactly `size` bytes, or nothing if the input is damaged or gives
// another number of bytes. Format: the description in liblzf's documentation, by M. Lehmann.
// O(size).
std::optional<std::vector<std::uint8_t>> unpackLzf(std::span<const std::uint8_t> packed,
                                                   std::size_t size);

}  // namespace merlin::render::range
