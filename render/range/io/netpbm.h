// Reads and writes PGM and PPM files (Netpbm): P2 and P5 with 8 and 16 bits for ranges and other
// scalars, P3 and P6 for colours. Comments in the file's header contain the keys of image_header.h.
// Format: the manual pages pgm(5) and ppm(5) of Netpbm.
#pragma once

#include <string_view>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

bool isNetpbm(std::string_view bytes) noexcept;

// Parses a file; `bytes` is the whole file. Errors, with the line of the header: kMalformed (also
// if the file ends before its last pixel), kUnsupported (P1, P4, P7, more than kMostPixels pixels).
Result<StoredImage> parseNetpbm(std::string_view bytes);

// Writes a PGM of the ranges with all of the image's geometry in its header, so that reading it
// returns the same image within half a step. A step is the difference between the largest and the
// smallest range, divided by 65534 (16 bits) or 254 (8 bits). Planes are not written; the header
// names the files of `features`. Returns false if a write failed. REQUIRES: bits is 8 or 16, the
// geometry is not kRays.
bool writePgm(const RangeImage& image, int bits, const WriteBytes& write,
              const std::vector<FeatureFile>& features = {});

}  // namespace merlin::render::range
