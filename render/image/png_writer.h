// Writes an image to a PNG file, with libpng. Takes about 100 ms for a frame: never on the wall's
// thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::image {

// `pixels`: RGBA, rows from top to bottom, 4 * width * height bytes; alpha is not written. The file
// appears whole or not at all. The same pixels give the same bytes. Errors: those of writeFile().
Result<Ok> writePng(const std::string& path, int width, int height,
                    std::span<const std::uint8_t> pixels);

// Returns the bytes of a PNG file. `pixels`: RGB, rows from top to bottom. The same pixels give the
// same bytes. About 30 ms for a million pixels. Errors: kIo (no memory), kInvalidArgument (the size
// is not that of `pixels`, or 0).
Result<std::vector<std::uint8_t>> encodePng(int width, int height,
                                            std::span<const std::uint8_t> pixels);

}  // namespace merlin::render::image
