// The import of pictures for `merlin image import` and `merlin show`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

struct ImageImport {
  std::string input, output;  // the picture to import, and the pyramid to write (.tif)
  bool panorama = false, json = false;
  int quality = 90;  // JPEG quality; 0: lossless
  int tile_px = 256;
  // The pixel values that become black and white. Empty: the values are unchanged, or the range is
  // determined from them.
  std::vector<double> range;
  // Limit for the address space of merlin-import [bytes].
  std::size_t memory = std::size_t{4'000'000'000};
  bool quiet = false;           // no summary; notes and progress are still printed
  ProgressListener progress{};  // may be empty
};

// Imports the picture; prints notes, progress and the summary. Blocks SIGINT, SIGTERM and SIGHUP,
// also afterwards; each of them ends the import without leaving files behind. Errors: kNotFound,
// kInvalidArgument (`output` does not end in .tif), kClosed (a signal), those of merlin-import.
Result<Ok> importImage(const ImageImport& options);

}  // namespace merlin::cli
