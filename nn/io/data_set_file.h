// Data sets as CSV: a header, then one hand a line. The format: nn/io/README.md.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/data_set.h"

namespace merlin::nn {

// Reads a file whole or not at all. Every error names the file and the line, says what was found
// and what is allowed. Errors: kNotFound, kIo, kMalformed.
Result<DataSet> loadDataSet(const std::string& path);

// The same of a text; `file` is its name in errors.
Result<DataSet> parseDataSet(std::string_view text, const std::string& file);

// The inverse, exact: what is read back equals what was written.
std::string formatDataSet(std::span<const LabelledHand> hands);

// Replaces `path` by a whole file or leaves it as it was. Errors: kIo; kInvalidArgument: what
// loadDataSet() would refuse.
Result<Ok> saveDataSet(const std::string& path, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
