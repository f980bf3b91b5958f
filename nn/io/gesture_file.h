// Trained gestures as a file: JSON, version 1. nn/io/README.md describes it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/gesture/recogniser.h"

namespace merlin::nn {

struct GestureProvenance {
  std::string how;             // for a person
  std::uint64_t takes = 0;     // strokes that were meant as gestures
  std::uint64_t ordinary = 0;  // strokes of ordinary motion
  bool synthetic = false;      // any of them is generated
};

struct GestureFile {
  GestureModel model;
  GestureProvenance trained;
};

// Reads a whole file or nothing. The error is the first fault: it names the file, the place (a JSON
// pointer), what was found there and what is allowed.
// Errors: kNotFound, kIo, kMalformed, kUnsupported (any other version).
Result<GestureFile> loadGestures(const std::string& path);

// The same for a text; `file` is its name in errors.
Result<GestureFile> parseGestures(std::string_view text, const std::string& file);

// The exact inverse: reading the text back gives equal numbers (-0 becomes 0).
std::string formatGestures(const GestureFile& file);

// Replaces `path` by a whole file or leaves it unchanged. Errors: kIo; kInvalidArgument if
// loadGestures() would refuse the result.
Result<Ok> saveGestures(const std::string& path, const GestureFile& file);

}  // namespace merlin::nn
