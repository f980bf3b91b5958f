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
  // Slots that have a column in the file. In a file in radians, a missing DIP angle is computed
  // from the PIP angle, as the glove's driver does; other missing slots are 0.
  Slots measured{};
  bool synthetic = false;          // the file says that its hands are generated
  std::vector<std::string> notes;  // assumptions that were made, for the user
};

// Reads a recording; a file with any fault is refused as a whole. `unit` is the unit of the file's
// numbers; if absent, radians are assumed, or raw counts if a number is beyond +-6.3. `columns`:
// what certain columns contain, if the header does not say it. Every error names the file and the
// line, what was found and what is allowed. Errors: kNotFound, kIo, kMalformed.
Result<Recording> loadRecording(const std::string& path, std::optional<InputUnit> unit = {},
                                std::span<const ChosenColumn> columns = {});

// Parses the text of a recording as loadRecording() does. `file`: the file's name in errors.
// Errors: kMalformed.
Result<Recording> parseRecording(std::string_view text, const std::string& file,
                                 std::optional<InputUnit> unit = {},
                                 std::span<const ChosenColumn> columns = {});

// Returns the recording as the text of a file, with the measured slots only. parseRecording() of
// this text with the same unit gives equal values.
std::string formatRecording(const Recording& recording);

// Writes a recording to `path`; after an error, an existing file is unchanged. Errors: kNotFound
// (no such folder), kIo; kInvalidArgument if loadRecording() would refuse the result.
Result<Ok> saveRecording(const std::string& path, const Recording& recording);

}  // namespace merlin::nn
