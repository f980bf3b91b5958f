// The posture network's file: JSON, version 2; version 1 is read too. The format: nn/io/README.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/fit.h"
#include "nn/postures.h"

namespace merlin::nn {

struct NetworkFile {
  PostureNetwork network;
  Provenance trained;
  std::optional<Memory> memory;  // what adapting rehearses; absent in version 1
};

// Reads a file whole or not at all. Every error names the file and says where the fault stands
// (a JSON pointer), what was found there and what is allowed; the first fault is the one told.
// Errors: kNotFound, kIo, kMalformed, kUnsupported (a version that is neither).
Result<NetworkFile> loadNetwork(const std::string& path);

// The same of a text; `file` is its name in errors.
Result<NetworkFile> parseNetwork(std::string_view text, const std::string& file);

// The inverse, exact: what is read back equals what was written, number for number (-0 becomes 0).
// Always version 2.
std::string formatNetwork(const NetworkFile& file);

// Replaces `path` by a whole file or leaves it as it was. Errors: kIo; kInvalidArgument: what
// loadNetwork() would refuse, a weight that is not finite among it.
Result<Ok> saveNetwork(const std::string& path, const NetworkFile& file);

}  // namespace merlin::nn
