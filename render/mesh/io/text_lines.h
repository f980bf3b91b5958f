// Splits text into lines and words, for text-based mesh formats. Private to render/mesh/io.
#pragma once

#include <algorithm>
#include <charconv>
#include <string_view>

namespace merlin::render::mesh {

// Removes the first line from `text`; returns it without its line feed and its comment, which
// begins with "#".
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line.substr(0, line.find('#'));
}

// Removes the first word from `text` and returns it; empty if there is none.
inline std::string_view takeWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
  text.remove_prefix(word.size());
  return word;
}

// `text` without leading and trailing blanks. Blanks inside stay: file names may contain them.
inline std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t\r") + 1);
}

// Parses `word`; false unless the whole word is a number.
template <typename T>
bool readNumber(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && rest == end && !word.empty();
}

}  // namespace merlin::render::mesh
