// Pictures that lie beside a mesh: PNG by libpng, JPEG by TurboJPEG. Private to render/mesh/io.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render {

struct PictureFile {
  int width = 0, height = 0;         // [px]
  std::vector<std::uint8_t> pixels;  // RGB, rows from top to bottom

  // Of the place (u, v), v upwards, as texture coordinates have it: mixed of the four nearest
  // pixels, 0..1 each. The picture repeats, unless `clamped`. REQUIRES: u, v finite, not empty.
  std::array<float, 3> at(float u, float v, bool clamped) const noexcept;
};

// By the file's first bytes, whatever its name. Errors, with the file's name: kNotFound, kIo,
// kMalformed, kUnsupported (neither PNG nor JPEG, or more than 2^28 pixels).
Result<PictureFile> readPicture(const std::string& path);

}  // namespace merlin::render
