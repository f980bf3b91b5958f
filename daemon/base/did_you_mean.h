// Spelling suggestion: the known word nearest to a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin {

// The known word with the smallest optimal string alignment distance (edits of one letter, swaps of
// two neighbours) from `word`, the first one if several are equally near; empty if the distance
// exceeds half of the word's length.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

}  // namespace merlin
