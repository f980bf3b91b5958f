// Makes pyramids (render/image/pyramid_file.h) of pictures of any format that libvips reads. Only
// the program merlin-import links this, behind its sandbox.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "daemon/base/result.h"

namespace merlin::render::import {

struct PyramidOptions {
  bool panorama = false;  // mark the file as an equirectangular panorama
  int quality = 90;       // of JPEG, 1 to 100; 0: no loss (deflate)
  int tile_px = 256;      // 256 or 512
  // The values that become black and white; nothing: of measured values (value_range.h) those found
  // in the picture, of colours as the format has them.
  std::optional<std::array<double, 2>> range{};
};

struct ImportedPicture {
  std::int64_t width = 0, height = 0;  // [px]
};

// Loads what the library needs from the system, such as its modules. To be called once, before the
// sandbox closes. Errors: kUnsupported.
Result<Ok> prepareImport(const char* program);

// Called with the part of the work that is done, 0..1, and the number of pixels that have been
// read.
using OnProgress = std::function<void(double share, std::int64_t pixels)>;
// Called with the picture's size as soon as it is known; an error ends the import.
using OnSize = std::function<Result<Ok>(const ImportedPicture&)>;
// Called with sentences for the user about what was assumed.
using OnNote = std::function<void(const std::string&)>;

// Whom an import tells what.
struct PictureReports {
  OnSize size;
  OnProgress progress;
  OnNote note;
};

// Reads `in`, turns it upright, converts it to 8-bit sRGB (by its colour profile, if it has one;
// measured values by their range), puts transparent pixels before black, and writes the pyramid to
// `out`. Pixels are streamed where the format allows it; measured values are read twice. Errors:
// kMalformed (not an image, or damaged or cut), kUnsupported (a video), kIo (the result cannot be
// written), each with libvips' own words where it has some.
Result<ImportedPicture> importPicture(const std::string& in, const std::string& out,
                                      const PyramidOptions& options, const PictureReports& reports);

}  // namespace merlin::render::import
