// Converts images of any format that libvips reads to pyramids (render/image/pyramid_file.h).
// Linked only into the program merlin-import, which runs it in its sandbox.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "daemon/base/result.h"

namespace merlin::render::import {

struct PyramidOptions {
  bool panorama = false;  // whether to mark the file as an equirectangular panorama
  int quality = 90;       // JPEG quality, 1 to 100; 0: lossless (deflate)
  int tile_px = 256;      // side of a tile [px]: 256 or 512
  // The values displayed as black and white. If not set: for measured values (value_range.h) the
  // range found in the image, for colours the range of the format.
  std::optional<std::array<double, 2>> range{};
};

struct ImportedPicture {
  std::int64_t width = 0, height = 0;  // [px]
};

// Loads the files that libvips needs from the system, such as its modules. Call once, before the
// sandbox closes. Errors: kUnsupported.
Result<Ok> prepareImport(const char* program);

// Progress callback: receives the share of the work that is done, 0..1, and the number of pixels
// that have been read.
using OnProgress = std::function<void(double share, std::int64_t pixels)>;
// Callback that receives the image's size as soon as it is known; if it returns an error, the
// import ends with that error.
using OnSize = std::function<Result<Ok>(const ImportedPicture&)>;
// Callback that receives sentences for the user about assumptions that were made.
using OnNote = std::function<void(const std::string&)>;

// The callbacks of an import.
struct PictureReports {
  OnSize size;
  OnProgress progress;
  OnNote note;
};

// Reads the picture `in`, turns it upright, converts it to 8-bit sRGB (by its colour profile, if it
// has one; measured values by their range), blends transparent pixels with black, and writes the
// pyramid to `out`. Returns the picture's size. Pixels are streamed if the format allows it;
// measured values are read twice. Errors: kMalformed (not an image, damaged or truncated),
// kUnsupported (a video; a picture too thin for a pyramid), kIo (the result cannot be written),
// each with libvips' own message if there is one.
Result<ImportedPicture> importPicture(const std::string& in, const std::string& out,
                                      const PyramidOptions& options, const PictureReports& reports);

}  // namespace merlin::render::import
