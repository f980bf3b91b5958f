// Reads UTF-8 (RFC 3629) character by character, whatever the bytes are. Pure.
#pragma once

#include <string_view>

namespace merlin::render::text {

// Stands for a byte that belongs to no character.
inline constexpr char32_t kNoCharacter = 0xFFFD;

// Removes the first character from `rest` and returns it; kNoCharacter, for one byte, if the bytes
// are not UTF-8 there. REQUIRES: `rest` is not empty.
char32_t takeCharacter(std::string_view& rest) noexcept;

}  // namespace merlin::render::text
