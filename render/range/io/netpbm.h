// PGM and PPM files (Netpbm): P2, P5 with 8 and 16 bits for ranges and other scalars, P3, P6 for
// colours. Comments of the header carry the keys of image_header.h. Format: the manual pages pgm(5)
// and ppm(5) of Netpbm.
#pragma once

#include <string_view>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

bool isNetpbm(std::string_view bytes) noexcept;

// `bytes` is a whole file. Errors, with the line of the header: kMalformed (also if it ends before
// its last pixel), kUnsupported (P1, P4, more than kMostPixels).
Result<StoredImage> parseNetpbm(std::string_view bytes);

// Writes a PGM of the ranges with all of the image's geometry in its header, so that reading it
// gives the same image within half a step of the largest range's 1/65534 (16 bits) or 1/254 (8
// bits). Planes are not written; the header names the files of `features`. Returns false if a write
// failed. REQUIRES: bits is 8 or 16, the geometry is not kRays.
bool writePgm(const RangeImage& image, int bits, const WriteBytes& write,
              const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
