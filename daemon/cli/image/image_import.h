// The import of `merlin image import`, which `merlin show` makes as well.
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
  int quality = 90;  // of JPEG; 0: lossless
  int tile_px = 256;
  std::vector<double>
      range;  // the values that become black and white; empty: as they are, or found
  std::size_t memory = std::size_t{4'000'000'000};  // address space of merlin-import [bytes]
  bool quiet = false;           // no summary; notes and progress are printed all the same
  ProgressListener progress{};  // may be empty
};

// Imports the picture; prints notes, progress and the summary. SIGINT, SIGTERM and SIGHUP end it
// and are blocked from then on; nothing is left behind. Errors: kNotFound, kInvalidArgument
// (another ending), kClosed (a signal), those of merlin-import.
Result<Ok> importImage(const ImageImport& options);

}  // namespace merlin::cli
