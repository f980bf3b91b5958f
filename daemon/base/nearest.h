// The nearest of some known words to one that was mistyped.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin {

// By edits of one letter or swaps of two neighbours (optimal string alignment distance), at most
// half of the word's length away; empty if none is that near. Ties go to the first.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace merlin
