// Reads and writes the texts of fixed size in shared memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace merlin {

// Returns the text in a field. It ends at the first zero byte, or with the field if there is none.
template <std::size_t N>
constexpr std::string_view textIn(const char (&field)[N]) noexcept {
  return std::string_view(field, N).substr(0, std::string_view(field, N).find('\0'));
}

// Writes the text into a field, cut to at most N - 1 bytes, and fills the rest with zero bytes.
template <std::size_t N>
constexpr void setText(char (&field)[N], std::string_view text) noexcept {
  const std::size_t length = std::min(text.size(), N - 1);
  std::copy_n(text.begin(), length, field);
  std::fill(field + length, field + N, '\0');
}

}  // namespace merlin
