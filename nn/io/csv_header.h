// Reads the header of a recording: the column of the label, and the slot of each other column.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nn/inputs.h"

namespace merlin::nn {

struct CsvHeader {
  std::size_t label = 0;           // column
  std::vector<int> slot;           // one for each column; -1 for the label and for ignored columns
  std::vector<std::string> notes;  // assumptions that were made
};

// Finds columns by their names. The label is "posture", "label", "class" or another of kLabelNames,
// or has one of these in its name; sensors are "s0".."s22" or the names of kInputNames. If the
// sensors have other names, their number (18, 22 or 23) and order decide, as in the glove's mask.
// Returns what is wrong with the header; nothing if it is valid.
std::optional<std::string> readHeader(const std::vector<std::string>& names, CsvHeader& header);

// Returns a name in lower case, without quotes and outer blanks; inner blanks and '_' become '-'.
std::string plainName(std::string_view text);

}  // namespace merlin::nn
