// The header of a recording: which column is the label, and which slot each of the others is.
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
  std::vector<int> slot;           // of each column, -1 for the label and for what is left out
  std::vector<std::string> notes;  // what was guessed
};

// Columns by name: the label is "posture", "label", "class" or another of kLabelNames, or has one
// of these in its name; sensors are "s0".."s22" or the names of kInputNames. Where the sensors'
// names say nothing, their number and order do: 18, 22 or 23, as the glove's mask has them. Returns
// what is wrong with it, else nothing.
std::optional<std::string> readHeader(const std::vector<std::string>& names, CsvHeader& header);

// Lower case, without quotes and blanks at the ends; inner blanks and '_' become '-'.
std::string plainName(std::string_view text);

}  // namespace merlin::nn
