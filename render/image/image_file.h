// Image files, such as the textures of meshes: PNG by libpng, JPEG by TurboJPEG.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::image {

// What texture coordinates outside the image show: the image repeated, its mirror image, or the
// pixels of its border.
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

// Returns the pixel, 0..n-1, that is shown for pixel `i`, which may be outside, of a row or column
// of `n` pixels. REQUIRES: n > 0.
int wrapped(std::int64_t i, int n, Wrap wrap) noexcept;

struct ImageFile {
  int width = 0, height = 0;         // [px]
  std::vector<std::uint8_t> pixels;  // RGB, rows from top to bottom
  std::vector<std::uint8_t> file{};  // the encoded file; only readImage() sets it

  // Returns the colour at texture coordinates (u, v), v upwards: interpolated between the four
  // nearest pixels, each component 0..1. REQUIRES: u and v are finite, the image is not empty.
  std::array<float, 3> at(float u, float v, Wrap wrap_u, Wrap wrap_v) const noexcept;
};

// Reads a PNG or JPEG file; its first bytes decide which, not its name. Errors, with the file's
// name: kNotFound, kIo, kMalformed, kUnsupported (neither PNG nor JPEG, or more than 2^28 pixels).
Result<ImageFile> readImage(const std::string& path);

// Returns the memory that readImage() needs for the pixels [bytes], read from the header of the
// file alone. Errors: those of readImage().
Result<std::size_t> imageBytes(const std::string& path);

// Decodes an image file that is in memory. Errors: those of readImage(), without a file name.
// Damaged or hostile bytes are rejected, or decoded as far as the libraries can.
Result<ImageFile> decodeImage(std::span<const std::uint8_t> bytes);

}  // namespace merlin::render::image
