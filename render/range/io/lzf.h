// Decompresses LZF, the compression of binary_compressed PCD files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace merlin::render::range {

// Decompresses LZF data. Returns exactly `size` bytes, or nothing if the input is damaged or
// decompresses to a different number of bytes. O(size).
//
// The format: a control byte c below 32 is followed by c + 1 bytes, which are copied to the output.
// Any other control byte has a length in its upper three bits (if it is 7, the next byte is added
// to it); its lower five bits and the next byte are a distance. Then length + 2 bytes are copied
// from distance + 1 bytes back in the output. Source: the documentation of liblzf, by M. Lehmann.
std::optional<std::vector<std::uint8_t>> unpackLzf(std::span<const std::uint8_t> packed,
                                                   std::size_t size);

}  // namespace merlin::render::range
