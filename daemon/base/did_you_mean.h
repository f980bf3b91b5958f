// Spelling suggestion: the known word nearest to a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin {

// Returns the word in `known` with the smallest optimal string alignment distance (edits of one
// letter, swaps of two neighbours) from `word`; of several such words, the first. Returns an empty
// text if that distance exceeds half of the length of `word` (at least 1), or if `word` has more
// than 64 bytes.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

}  // namespace merlin
