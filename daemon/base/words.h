// Lines, words and numbers of text. Pure; text is taken as bytes, letters are those of ASCII.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

namespace merlin {

inline constexpr std::string_view kBlanks = " \t\r";  // between words of a line

// Removes the first line from `text`; returns it without its line feed.
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// Removes the first word from `text` and returns it; empty if there is none.
inline std::string_view takeWord(std::string_view& text, std::string_view blanks = kBlanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

inline std::size_t wordsIn(std::string_view text, std::string_view blanks = kBlanks) {
  std::size_t words = 0;
  while (!takeWord(text, blanks).empty()) ++words;
  return words;
}

// `text` without leading and trailing blanks. Blanks inside stay: file names may contain them.
inline std::string_view trimmed(std::string_view text, std::string_view blanks = kBlanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

// Parses `word`, which may begin with "+"; false unless the whole word is a number.
template <typename T>
bool readNumber(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && rest == end && !word.empty();
}

inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

}  // namespace merlin
