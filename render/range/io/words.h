// Splits text into lines and words and reads numbers, for the text parts of range files. Private to
// render/range/io.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::render::range {

inline constexpr double kDegree = std::numbers::pi / 180;  // [rad]
inline constexpr std::string_view kBlanks = " \t\r\n\v\f";

// Removes the first line from `text`; returns it without its line feed.
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// Removes the first word from `text` and returns it; empty if there is none.
inline std::string_view takeWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

// `text` without leading and trailing blanks.
inline std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

inline std::string inLowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

// Parses `word`; false unless the whole word is a number.
template <typename T>
bool readNumber(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && rest == end && !word.empty();
}

// The words of `text` as finite numbers of up to 1e30 in size; empty if one of them is none, or if
// there are more than `most`.
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
