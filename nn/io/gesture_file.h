// Trained gestures as a file: JSON, version 1. nn/io/README.md describes it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/gesture/recogniser.h"

namespace merlin::nn {

struct GestureProvenance {
  std::string how;             // description for people
  std::uint64_t takes = 0;     // number of strokes that were meant as gestures
  std::uint64_t ordinary = 0;  // number of strokes of ordinary motion
  bool synthetic = false;      // whether any of these strokes is generated
};

struct GestureFile {
  GestureModel model;
  GestureProvenance trained;
};

// Reads a gesture file; a file with any fault is refused as a whole. The error is the first fault:
// it names the file, the place (a JSON pointer), what was found there and what is allowed. Errors:
// kNotFound, kIo, kMalformed, kUnsupported (any other version).
Result<GestureFile> loadGestures(const std::string& path);

// Parses the text of a gesture file as loadGestures() does. `file`: the file's name in errors.
// Errors: kMalformed, kUnsupported.
Result<GestureFile> parseGestures(std::string_view text, const std::string& file);

// Returns the text of a gesture file. parseGestures() of this text gives equal numbers (-0 becomes
// 0).
std::string formatGestures(const GestureFile& file);

// Writes a gesture file to `path`; after an error, an existing file is unchanged. Errors: kNotFound
// (no such folder), kIo; kInvalidArgument if loadGestures() would refuse the result.
Result<Ok> saveGestures(const std::string& path, const GestureFile& file);

}  // namespace merlin::nn
