// Reads the texts of fixed size in shared memory.
#pragma once

#include <cstddef>
#include <string_view>

namespace merlin {

// The text in a field, which ends at its first zero byte, or with the field if it has none.
template <std::size_t N>
constexpr std::string_view textIn(const char (&field)[N]) noexcept {
  return std::string_view(field, N).substr(0, std::string_view(field, N).find('\0'));
}

}  // namespace merlin
