// PNG files whose pixels are numbers and not a picture: 16 bits a channel, as stored in the file,
// without any gamma. Uses libpng.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::image {

struct Levels {
  int width = 0, height = 0;
  int channels = 3;                   // 3: red, green, blue; 1: grey
  std::vector<std::uint16_t> values;  // 0..65535, rows from top to bottom
};

// Decodes a file's bytes to three channels, from any kind of PNG; 8-bit values are scaled to 16
// bits (255 becomes 65535), and alpha is left out. Errors: kMalformed, kUnsupported (more than
// `most_pixels`).
Result<Levels> decodeLevels(std::span<const std::byte> png, std::size_t most_pixels);

// Returns the bytes of a PNG file with one channel of 16 bits. The same values give the same bytes.
// Errors: kIo (no memory). REQUIRES: channels = 1, width * height values.
Result<std::string> encodeLevels(const Levels& levels);

}  // namespace merlin::render::image
