// Multiplies images by a colour, as materials of models require it.
#pragma once

#include <array>

#include "daemon/base/result.h"
#include "render/image/image_file.h"

namespace merlin::render::image {

// Which values are multiplied: the stored ones, or values proportional to light (sRGB is decoded,
// and encoded again afterwards).
enum class Light : std::uint8_t { kStored, kLinear };

// Returns the picture with each channel multiplied by its factor (clamped to 0..1), and with a new
// PNG file of it. Errors: those of encodePng().
Result<ImageFile> tinted(const ImageFile& picture, const std::array<float, 3>& factor, Light light);

}  // namespace merlin::render::image
