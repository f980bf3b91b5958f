// Writes range images as FITS (Flexible Image Transport System, version 4.0 of the standard, with
// its convention for long strings). merlin-import reads FITS files through CFITSIO.
#pragma once

#include <vector>

#include "daemon/base/files.h"
#include "render/range/io/image_header.h"
#include "render/range/range_image.h"

namespace merlin::render::range {

// Writes the ranges as floats, with the cards (header records) of README.md; reading the file
// returns the same bits. Pixels without a return are NaN. Planes are not written; cards name the
// files of `features`. Returns false if a write failed. REQUIRES: the scanner is kOrthogonal,
// kSpinning or kPinhole.
bool writeFits(const RangeImage& image, const WriteBytes& write,
               const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
