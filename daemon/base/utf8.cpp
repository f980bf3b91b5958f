#include "daemon/base/utf8.h"

#include <cassert>
#include <cstddef>

namespace merlin {
namespace {

// Returns the number of bytes of the character whose first byte is `first`; 0 if no character
// begins with this byte.
std::size_t lengthOf(char32_t first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

bool isCharacter(char32_t code, std::size_t length) {
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  return code >= kLeast[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
}

}  // namespace

char32_t takeCharacter(std::string_view& rest) noexcept {
  assert(!rest.empty());
  const auto byte = [&rest](std::size_t i) -> char32_t {
    return static_cast<unsigned char>(rest[i]);
  };
  const std::size_t length = lengthOf(byte(0));
  char32_t code = length < 2 ? byte(0) : byte(0) & (0x7FU >> length);
  bool valid = length > 0 && length <= rest.size();
  for (std::size_t i = 1; valid && i < length; ++i) {
    valid = (byte(i) & 0xC0U) == 0x80U;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  valid = valid && isCharacter(code, length);
  rest.remove_prefix(valid ? length : 1);
  return valid ? code : kNoCharacter;
}

}  // namespace merlin
