// Pictures times a colour, as materials ask for it.
#pragma once

#include <array>

#include "daemon/base/result.h"
#include "render/image/image_file.h"

namespace merlin::render::image {

// In which numbers colours are multiplied: as they are stored, or proportional to light (sRGB
// decoded, and encoded again).
enum class Light : std::uint8_t { kStored, kLinear };

// The picture with each channel times its factor, 0..1 (others are held there), and with a PNG file
// of its own. Errors: those of encodePng().
Result<ImageFile> tinted(const ImageFile& picture, const std::array<float, 3>& factor, Light light);

}  // namespace merlin::render::image
