// Reads the header of a recording: the column of the label, and the slot of each other column.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nn/inputs.h"

namespace merlin::nn {

// The user's choice of what a column contains, if the header does not say it.
struct ChosenColumn {
  std::string what;    // "posture", or a sensor by its joint or slot: "thumb-roll", "s0"
  std::string column;  // the column's name in the header, or its number from 1
};

struct CsvHeader {
  std::size_t label = 0;           // column
  std::vector<int> slot;           // one for each column; -1 for the label and for ignored columns
  std::vector<std::string> notes;  // assumptions that were made
};

// Finds columns by their names. The label is "posture", "label", "class" or another of kLabelNames,
// or has one of these in its name; sensors are "s0".."s22" or the names of kInputNames. If the
// sensors have other names, their number (18, 22 or 23) and order decide, as in the glove's mask.
// `chosen` takes precedence over all of this; if it contains a sensor, columns that were not chosen
// are left out. Returns what is wrong with the header or the choice, "...; allowed: ..."; nothing
// if all is valid.
std::optional<std::string> readHeader(const std::vector<std::string>& names, CsvHeader& header,
                                      std::span<const ChosenColumn> chosen = {});

// Returns a name in lower case, without quotes and outer blanks; inner blanks and '_' become '-'.
std::string plainName(std::string_view text);

}  // namespace merlin::nn
