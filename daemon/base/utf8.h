// Reads UTF-8 (RFC 3629) character by character, whatever the bytes are. Pure.
#pragma once

#include <cstddef>
#include <string_view>

namespace merlin {

// Returns the number of bytes of the character whose first byte is `first`; 0 if no character
// begins with this byte.
std::size_t characterLength(char first) noexcept;

// Stands for a byte that belongs to no character.
inline constexpr char32_t kNoCharacter = 0xFFFD;

// Removes the first character from `rest` and returns it; removes one byte and returns kNoCharacter
// if the bytes are not UTF-8 there. (kNoCharacter itself, U+FFFD, is a character of three bytes.)
// REQUIRES: `rest` is not empty.
char32_t takeCharacter(std::string_view& rest) noexcept;

}  // namespace merlin
