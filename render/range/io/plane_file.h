// Reads and writes registered images of other modalities, each in a file of its own.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Reads an image of the same size as the range image: PGM as one value per pixel, with the scale
// and the unit of its header; PPM, PNG and JPEG as colours of 0..1, or as one value per pixel of
// 0..255 (a PNG of 16 bits: 0..65535, the figures as they are stored, without any gamma) if red,
// green and blue are equal everywhere and `name` is not "colour". The content decides, not the
// file's ending. Errors, with the file's name: kNotFound, kIo, kMalformed, kUnsupported,
// kInvalidArgument (another size: both are named).
Result<Plane> readPlane(const std::string& name, const std::string& path, const RangeImage& image);

// The ending of the file that writePlane() writes for the plane: ".png" for colours, else ".pgm".
const char* endingOf(const Plane& plane);

// Writes a plane so that readPlane() gives it back: colours (dimension 3, each 0..1) as PNG with 8
// bits; one value per pixel as PGM with 16 bits, whose header has the unit and the scale: the
// plane's range, widened to include its values. Whole numbers that differ by at most 65535 are kept
// exactly, unless an end of the range is not a whole number. Only pixels with a return count; the
// others are written as the lowest value. Errors: those of writeFile(). REQUIRES: dimension 1
// or 3, finite values.
Result<Ok> writePlane(const std::string& path, const Plane& plane, const RangeImage& image);

}  // namespace merlin::render::range
