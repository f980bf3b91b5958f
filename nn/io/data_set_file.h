// Data sets as CSV: a header, then one hand in each line. nn/io/README.md describes the format.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/io/csv_header.h"
#include "nn/space.h"

namespace merlin::nn {

struct Recording {
  DataSet hands;
  InputUnit unit = InputUnit::kRadians;
  Slots measured{};  // slots that the file has; the others are filled as the glove's driver does
  bool synthetic = false;          // the file says that its hands are generated
  std::vector<std::string> notes;  // assumptions that were made, for the user
};

// Reads a whole file or nothing. `unit` is the unit of its numbers; if absent, radians are assumed
// unless a number is beyond +-6.3. `columns`: what certain columns contain, if the header does not
// say it. Every error names the file and the line, what was found and what is allowed. Errors:
// kNotFound, kIo, kMalformed.
Result<Recording> loadRecording(const std::string& path, std::optional<InputUnit> unit = {},
                                std::span<const ChosenColumn> columns = {});

// The same for a text; `file` is its name in errors.
Result<Recording> parseRecording(std::string_view text, const std::string& file,
                                 std::optional<InputUnit> unit = {},
                                 std::span<const ChosenColumn> columns = {});

// The exact inverse: reading the text back gives equal values. Writes the measured slots only.
std::string formatRecording(const Recording& recording);

// Replaces `path` by a whole file or leaves it unchanged. Errors: kIo; kInvalidArgument if
// loadRecording() would refuse the result.
Result<Ok> saveRecording(const std::string& path, const Recording& recording);

}  // namespace merlin::nn
