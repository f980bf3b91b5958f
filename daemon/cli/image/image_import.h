// The import of pictures for `merlin image import` and `merlin show`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

struct ImageImport {
  std::string input, output;  // a picture, and the pyramid (.tif)
  bool panorama = false, json = false;
  int quality = 90;  // quality of JPEG; 0: lossless
  int tile_px = 256;
  std::vector<double> range;  // the values that become black and white; empty: values as they are,
                              // or a range determined from them
  std::size_t memory = std::size_t{4'000'000'000};  // address space of merlin-import [bytes]
  bool quiet = false;           // no summary; notes and progress are still printed
  ProgressListener progress{};  // may be empty
};

// Imports the picture; prints notes, progress and the summary. SIGINT, SIGTERM and SIGHUP end the
// import, are blocked from then on, and leave no files behind. Errors: kNotFound, kInvalidArgument
// (another ending), kClosed (a signal), those of merlin-import.
Result<Ok> importImage(const ImageImport& options);

}  // namespace merlin::cli
