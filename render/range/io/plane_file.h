// Registered images of other modalities, from files of their own.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Reads an image of the same size as the range image: PGM as one value per pixel, with the scale
// and the unit of its header; PPM, PNG and JPEG as colours of 0..1, or as one value of 0..255 if
// red, green and blue are equal everywhere and `name` is not "colour". The content decides, not the
// file's ending. Errors, with the file's name: kNotFound, kIo, kMalformed, kUnsupported,
// kInvalidArgument (another size: both are named).
Result<Plane> readPlane(const std::string& name, const std::string& path, const RangeImage& image);

}  // namespace merlin::render::range
