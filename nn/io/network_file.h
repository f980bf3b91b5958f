// The posture network's file: JSON, version 2. nn/io/README.md describes it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/drift.h"
#include "nn/fit.h"
#include "nn/postures.h"

namespace merlin::nn {

struct NetworkFile {
  PostureNetwork network;
  Provenance trained;
  // For adapt() and DriftFollower. Absent if the file's "memory" is empty.
  std::optional<PostureStatistics> statistics;
};

// Returns the file's network and statistics, as needed to recognise postures. If the file has no
// statistics, they are empty, and drift is not followed.
TrainedPostures trainedPostures(const NetworkFile& file);

// Reads a network file; a file with any fault is refused as a whole. The error is the first fault:
// it names the file, the place (a JSON pointer), what was found there and what is allowed. Errors:
// kNotFound, kIo, kMalformed, kUnsupported (any other version).
Result<NetworkFile> loadNetwork(const std::string& path);

// Parses the text of a network file as loadNetwork() does. `file`: the file's name in errors.
// Errors: kMalformed, kUnsupported.
Result<NetworkFile> parseNetwork(std::string_view text, const std::string& file);

// Returns the text of a network file, version 2. parseNetwork() of this text gives equal numbers
// (-0 becomes 0).
std::string formatNetwork(const NetworkFile& file);

// Writes a network file to `path`; after an error, an existing file is unchanged. Errors: kNotFound
// (no such folder), kIo; kInvalidArgument if loadNetwork() would refuse the result, such as a
// weight that is not finite.
Result<Ok> saveNetwork(const std::string& path, const NetworkFile& file);

}  // namespace merlin::nn
