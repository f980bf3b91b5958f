// Lines and words of a text, for OBJ and its material files. Private to render/mesh/io.
#pragma once

#include <algorithm>
#include <charconv>
#include <string_view>

namespace merlin::render {

// Without its end; `text` is shortened by it. A comment ("# ...") is cut off.
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line.substr(0, line.find('#'));
}

// The first word of `text`, which is shortened by it; empty at its end.
inline std::string_view takeWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
  text.remove_prefix(word.size());
  return word;
}

// The rest of a line without blanks around it; a name may contain some.
inline std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t\r") + 1);
}

// Whether the whole word is a number.
template <typename T>
bool readNumber(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && rest == end && !word.empty();
}

}  // namespace merlin::render
