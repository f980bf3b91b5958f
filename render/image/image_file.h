// Pictures that belong to a mesh: PNG by libpng, JPEG by TurboJPEG.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render {

struct ImageFile {
  int width = 0, height = 0;         // [px]
  std::vector<std::uint8_t> pixels;  // RGB, rows from top to bottom
  std::vector<std::uint8_t> file{};  // of readImage(): its bytes

  // Colour at (u, v), v upwards, as in texture coordinates: interpolated from the four nearest
  // pixels, 0..1 each. The picture repeats, unless `clamped`. REQUIRES: u, v finite, not empty.
  std::array<float, 3> at(float u, float v, bool clamped) const noexcept;
};

// By the file's first bytes, whatever its name. Errors, with the file's name: kNotFound, kIo,
// kMalformed, kUnsupported (neither PNG nor JPEG, or more than 2^28 pixels).
Result<ImageFile> readImage(const std::string& path);

// Bytes that readImage() takes for its pixels, by the file's head. The same errors.
Result<std::size_t> imageBytes(const std::string& path);

// Decodes a file's bytes. The same errors, without a name. Hostile bytes are refused or read as
// well as the libraries can.
Result<ImageFile> decodeImage(std::span<const std::uint8_t> bytes);

}  // namespace merlin::render
