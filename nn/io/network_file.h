// The posture network's file: JSON, version 2; reads version 1 too. nn/io/README.md describes it.
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
  std::optional<PostureStatistics> statistics;  // for adapting and for drift; absent in version 1
};

// Returns what is needed to recognise the file's postures. Without statistics in the file, no drift
// is followed.
TrainedPostures trainedPostures(const NetworkFile& file);

// Reads a whole file or nothing. The error is the first fault: it names the file, the place (a JSON
// pointer), what was found there and what is allowed.
// Errors: kNotFound, kIo, kMalformed, kUnsupported (any other version).
Result<NetworkFile> loadNetwork(const std::string& path);

// The same for a text; `file` is its name in errors.
Result<NetworkFile> parseNetwork(std::string_view text, const std::string& file);

// The exact inverse: reading the text back gives equal numbers (-0 becomes 0).
// Always version 2.
std::string formatNetwork(const NetworkFile& file);

// Replaces `path` by a whole file or leaves it unchanged. Errors: kIo; kInvalidArgument if
// loadNetwork() would refuse the result, such as a weight that is not finite.
Result<Ok> saveNetwork(const std::string& path, const NetworkFile& file);

}  // namespace merlin::nn
