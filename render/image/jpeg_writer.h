// Encodes an image as JPEG, with TurboJPEG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/base/result.h"

namespace merlin::render::image {

// Returns the bytes of a JPEG file. `pixels`: RGBA, rows from top to bottom, 4 * width * height
// bytes; alpha is left out. `quality`: 1..100. The same pixels give the same bytes. About 5 ms for
// a million pixels. Errors: kIo (no memory), kUnsupported (wider or higher than 65,500 pixels).
// REQUIRES: width and height are at least 1.
Result<std::string> encodeJpeg(int width, int height, std::span<const std::uint8_t> pixels,
                               int quality);

}  // namespace merlin::render::image
