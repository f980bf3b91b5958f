// Recordings of a hand's path as CSV. nn/io/README.md describes the format.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/gesture/path_recording.h"

namespace merlin::nn {

// Reads a whole file or nothing. Every error names the file and the line, what was found and what
// is allowed. Errors: kNotFound, kIo, kMalformed.
Result<PathRecording> loadPaths(const std::string& path);

// The same for a text; `file` is its name in errors.
Result<PathRecording> parsePaths(std::string_view text, const std::string& file);

// The inverse; times are kept to the microsecond.
std::string formatPaths(const PathRecording& recording);

// Replaces `path` by a whole file or leaves it unchanged. Errors: kIo; kInvalidArgument if
// loadPaths() would refuse the result.
Result<Ok> savePaths(const std::string& path, const PathRecording& recording);

}  // namespace merlin::nn
