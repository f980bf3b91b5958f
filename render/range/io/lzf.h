// Decompresses LZF, the compression of binary_compressed PCD files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace merlin::render::range {

// A control byte below 32 is followed by that many bytes and one more, which are copied; any other
// has a length in its upper three bits (7: the next byte is added), and with the next byte a
// distance back, from where the length and two more bytes are copied. Returns exactly `size` bytes,
// or nothing if the input is damaged or gives another number. Format: the description in
// liblzf's documentation, by M. Lehmann. O(size).
std::optional<std::vector<std::uint8_t>> unpackLzf(std::span<const std::uint8_t> packed,
                                                   std::size_t size);

}  // namespace merlin::render::range
