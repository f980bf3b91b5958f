#include "daemon/base/utf8.h"

#include <cassert>

namespace merlin {
namespace {

bool isCharacter(char32_t code, std::size_t length) {
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  return code >= kLeast[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
}

}  // namespace

std::size_t characterLength(char first) noexcept {
  const auto byte = static_cast<unsigned char>(first);
  if (byte < 0x80) return 1;
  if (byte >= 0xC2 && byte < 0xE0) return 2;
  if (byte >= 0xE0 && byte < 0xF0) return 3;
  return byte >= 0xF0 && byte < 0xF5 ? 4 : 0;
}

char32_t takeCharacter(std::string_view& rest) noexcept {
  assert(!rest.empty());
  const auto byte = [&rest](std::size_t i) -> char32_t {
    return static_cast<unsigned char>(rest[i]);
  };
  const std::size_t length = characterLength(rest[0]);
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
