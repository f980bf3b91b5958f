// Reads and writes registered images of other modalities, each in a separate file.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Reads an image of the same size as the range image; the content, not the file's ending,
// determines the format. PGM gives one value per pixel, with the scale and the unit of its header.
// PPM, PNG and JPEG give colours, each 0..1. But if red, green and blue of a picture are equal
// everywhere and `name` is not "colour", it gives one value per pixel: 0..255, or for a PNG of 16
// bits 0..65535, as stored, without gamma correction. Errors, with the file's name: kNotFound, kIo,
// kMalformed, kUnsupported, kInvalidArgument (the sizes differ; the message contains both).
Result<Plane> readPlane(const std::string& name, const std::string& path, const RangeImage& image);

// Returns the ending of the file that writePlane() writes for the plane: ".png" for colours, else
// ".pgm".
const char* endingOf(const Plane& plane);

// Writes a plane so that readPlane() can read it back: colours (dimension 3, each 0..1) as PNG with
// 8 bits; one value per pixel as PGM with 16 bits, whose header has the unit and the scale: the
// plane's range, widened to include its values. Whole numbers that differ by at most 65535 are kept
// exactly, unless an end of the range is not a whole number. Pixels without a return in the range
// image are written as the lowest value. Errors: those of writeFile(). REQUIRES: dimension 1 or 3,
// finite values.
Result<Ok> writePlane(const std::string& path, const Plane& plane, const RangeImage& image);

}  // namespace merlin::render::range
