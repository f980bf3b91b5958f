#include "daemon/base/printable_text.h"

#include <cstdint>

#include <fmt/format.h>

#include "daemon/base/utf8.h"

namespace merlin {
namespace {

// Returns the size of the first character [bytes]; 0 if it is invalid or a control character.
// REQUIRES: `bytes` is not empty.
std::size_t characterAt(std::string_view bytes) noexcept {
  std::string_view rest = bytes;
  const char32_t code = takeCharacter(rest);
  const std::size_t size = bytes.size() - rest.size();
  const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
  return control || (code == kNoCharacter && size == 1) ? 0 : size;
}

}  // namespace

bool isText(std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const std::size_t size = characterAt(bytes);
    if (size == 0) return false;
    bytes.remove_prefix(size);
  }
  return true;
}

std::string_view wholeCharacters(std::string_view bytes) noexcept {
  for (std::size_t cut = 1; cut < 4 && cut <= bytes.size(); ++cut) {
    const std::size_t size = characterLength(bytes[bytes.size() - cut]);
    if (size == 0) continue;
    return size > cut ? bytes.substr(0, bytes.size() - cut) : bytes;
  }
  return bytes;
}

namespace {

std::string escaped(std::string_view bytes, bool keep_white) {
  std::string text;
  while (!bytes.empty()) {
    const bool white = bytes[0] == '\n' || bytes[0] == '\t';
    const std::size_t size = white && keep_white ? 1 : characterAt(bytes);
    if (size == 0)
      text += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(bytes[0]));
    else
      text += bytes.substr(0, size);
    bytes.remove_prefix(size == 0 ? 1 : size);
  }
  return text;
}

}  // namespace

std::string printable(std::string_view bytes) { return escaped(bytes, true); }

std::string oneLine(std::string_view bytes) { return escaped(bytes, false); }

std::string excerpt(std::string_view text) {
  constexpr std::size_t kMost = 64;
  if (text.size() <= kMost) return std::string(text);
  return std::string(wholeCharacters(text.substr(0, kMost))) + "...";
}

}  // namespace merlin
