// Data sets as CSV: a header, then one hand a line. The format: nn/io/README.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/space.h"

namespace merlin::nn {

struct Recording {
  DataSet hands;
  InputUnit unit = InputUnit::kRadians;
  Slots measured{};  // which slots the file has; others are filled, as the glove's driver does
  bool synthetic = false;          // the file says so of itself
  std::vector<std::string> notes;  // for the person who reads it: what was guessed
};

// Reads a file whole or not at all. `unit`: what its numbers are; absent: radians, unless one is
// beyond +-6.3. Every error names the file and the line, says what was found and what is allowed.
// Errors: kNotFound, kIo, kMalformed.
Result<Recording> loadRecording(const std::string& path, std::optional<InputUnit> unit = {});

// The same of a text; `file` is its name in errors.
Result<Recording> parseRecording(std::string_view text, const std::string& file,
                                 std::optional<InputUnit> unit = {});

// The inverse, exact: what is read back equals what was written. All 23 slots, or those measured.
std::string formatRecording(const Recording& recording);

// Replaces `path` by a whole file or leaves it as it was. Errors: kIo; kInvalidArgument: what
// loadRecording() would refuse.
Result<Ok> saveRecording(const std::string& path, const Recording& recording);

}  // namespace merlin::nn
