// Recordings of a hand's path as CSV. nn/io/README.md describes the format.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/gesture/path_recording.h"

namespace merlin::nn {

// Reads a path recording; a file with any fault is refused as a whole. Every error names the file
// and the line, what was found and what is allowed. Errors: kNotFound, kIo, kMalformed.
Result<PathRecording> loadPaths(const std::string& path);

// Parses the text of a path recording as loadPaths() does. `file`: the file's name in errors.
// Errors: kMalformed.
Result<PathRecording> parsePaths(std::string_view text, const std::string& file);

// Returns the recording as the text of a file, which parsePaths() reads back. Times are rounded to
// 1 us.
std::string formatPaths(const PathRecording& recording);

// Writes a path recording to `path`; after an error, an existing file is unchanged. Errors:
// kNotFound (no such folder), kIo; kInvalidArgument if loadPaths() would refuse the result.
Result<Ok> savePaths(const std::string& path, const PathRecording& recording);

}  // namespace merlin::nn
