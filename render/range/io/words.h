// Splits the text parts of range files into words and numbers; line feeds count as blanks. Private
// to render/range/io.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "daemon/base/words.h"

namespace merlin::render::range {

inline constexpr double kDegree = std::numbers::pi / 180;  // one degree in radians
// White space between words. It includes line feeds, because headers of netpbm files may break a
// line between any two words.
inline constexpr std::string_view kSpaces = " \t\r\n\v\f";

inline std::string_view takeWord(std::string_view& text) { return merlin::takeWord(text, kSpaces); }
inline std::string_view trimmed(std::string_view text) { return merlin::trimmed(text, kSpaces); }

// Returns the words of `text` as numbers. Returns an empty vector if a word is not a number with a
// magnitude of at most 1e30, or if there are more than `most` words.
inline std::vector<double> numbersOf(std::string_view text, std::size_t most) {
  std::vector<double> numbers;
  for (std::string_view word = takeWord(text); !word.empty(); word = takeWord(text)) {
    double number = 0;
    if (numbers.size() == most || !readNumber(word, number) || !(std::abs(number) <= 1e30))
      return {};
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace merlin::render::range
