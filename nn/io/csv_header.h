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
  std::size_t label = 0;           // index of the label's column
  std::vector<int> slot;           // of each column; -1 for the label and for ignored columns
  std::vector<std::string> notes;  // assumptions that were made, for the user
};

// Finds columns by their names. The label is "posture", "label", "class" or another name of
// kLabelNames (csv_header.cpp), or contains one of these words; sensors are "s0".."s22" or the
// names of kInputNames. If the sensors have other names, there must be 18, 22 or 23 of them, in the
// order of the glove's sensor mask. `chosen` takes precedence over all of this; if it contains a
// sensor, columns that were not chosen are left out. Returns a message, "...; allowed: ...", if the
// header or the choice is invalid, otherwise nothing.
std::optional<std::string> readHeader(const std::vector<std::string>& names, CsvHeader& header,
                                      std::span<const ChosenColumn> chosen = {});

// Returns a name in lower case, without quotes and outer blanks; inner blanks and '_' become '-'.
std::string plainName(std::string_view text);

}  // namespace merlin::nn
