#include "drivers/cyberglove/text.h"

#include <algorithm>
#include <charconv>

#include "daemon/base/bytes.h"

namespace merlin::cyberglove {
namespace {

using namespace std::string_literals;

constexpr std::string_view kSameInBoth = "iv?";  // queries that are equal in both dialogues

bool isUpper(char c) noexcept { return c >= 'A' && c <= 'Z'; }
bool isLower(char c) noexcept { return c >= 'a' && c <= 'z'; }
char lower(char c) noexcept { return isUpper(c) ? static_cast<char>(c - 'A' + 'a') : c; }
char upper(char c) noexcept { return isLower(c) ? static_cast<char>(c - 'a' + 'A') : c; }

// Removes the next word, which ends at a blank, from `rest` and returns it.
std::string_view word(std::string_view& rest) noexcept {
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  const std::string_view found = rest.substr(0, rest.find(' '));
  rest.remove_prefix(found.size());
  return found;
}

std::optional<std::uint32_t> number(std::string_view text, std::uint32_t most) noexcept {
  std::uint32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || stopped != end || value > most) return std::nullopt;
  return value;
}

std::string_view withoutLineEnd(std::string_view text) noexcept {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

// Returns the number of characters before the numbers: 2 for "?x", 1 for "x".
std::size_t head(std::string_view binary) noexcept { return binary.starts_with('?') ? 2 : 1; }

bool staysAsItIs(std::string_view binary) noexcept {
  return binary.empty() || binary[0] < ' ' ||
         (binary.size() >= 2 && binary[0] == '?' &&
          kSameInBoth.find(binary[1]) != std::string_view::npos);
}

// Removes the next number from the rest of a record; returns false if it is not a number or exceeds
// `most`.
bool take(std::string_view& rest, std::uint32_t most, std::uint32_t& value) noexcept {
  const auto found = number(word(rest), most);
  value = found.value_or(0);
  return found.has_value();
}

}  // namespace

bool isText(std::string_view command) noexcept {
  if (command.starts_with('?'))
    return command.size() >= 2 && isLower(command[1]) && !staysAsItIs(command);
  return !command.empty() && isLower(command[0]);
}

std::string asText(std::string_view binary) {
  if (staysAsItIs(binary)) return std::string(binary);
  if (binary[0] == 'e') return "e "s + std::string(binary.substr(1));
  const std::size_t letters = head(binary);
  std::string text(binary.substr(0, letters));
  for (char& c : text) c = lower(c);
  const bool words = text.back() == 't';
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(binary.data());
  for (std::size_t i = letters; i + (words ? 1 : 0) < binary.size(); i += words ? 2 : 1)
    text += ' ' + std::to_string(words ? loadBe16(bytes + i) : bytes[i]);
  return text;
}

std::optional<std::string> ofText(std::string_view text) {
  text = withoutLineEnd(text);
  if (staysAsItIs(text)) return std::string(text);
  if (text.size() == 3 && text.starts_with("e ")) return "e"s + text[2];
  if (!isText(text)) return std::nullopt;
  const std::size_t letters = head(text);
  std::string binary(text.substr(0, letters));
  for (char& c : binary) c = upper(c);
  const bool words = binary.back() == 'T';
  std::string_view rest = text.substr(letters);
  if (!rest.empty() && rest[0] != ' ') return std::nullopt;
  while (rest.find_first_not_of(' ') != std::string_view::npos) {
    const auto value = number(word(rest), words ? 0xFFFF : 0xFF);
    if (!value) return std::nullopt;
    if (words)
      appendBe16(binary, static_cast<std::uint16_t>(*value));
    else
      binary.push_back(static_cast<char>(*value));
  }
  return binary;
}

std::optional<Packet> readText(std::string_view text, const Layout& layout) noexcept {
  text = withoutLineEnd(text);
  if (text.size() == 3 && text.starts_with("e ")) return Refusal{text[2]};
  if (!text.starts_with("g ") && !text.starts_with("s ")) return std::nullopt;
  Record record;
  record.single = text[0] == 'g';
  std::string_view rest = text.substr(1);
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < layout.values; ++i) {
    if (!take(rest, 0xFF, value) || value == 0) return std::nullopt;
    record.values[i] = static_cast<std::uint8_t>(value);
  }
  if (layout.timestamp && !take(rest, 0xFFFFFFFF, record.timestamp)) return std::nullopt;
  if (layout.status) {
    if (!take(rest, 0xFF, value) || !(value & Record::kAlways)) return std::nullopt;
    record.status = static_cast<std::uint8_t>(value);
  }
  for (auto error = word(rest); !error.empty(); error = word(rest)) {
    if (error != "es" && error != "eg") return std::nullopt;
    (error == "es" ? record.too_fast : record.unplugged) = true;
  }
  return record;
}

std::string encodeText(const Record& record, const Layout& layout) {
  std::string out(1, record.single ? 'g' : 's');
  for (std::size_t i = 0; i < layout.values; ++i)
    out += ' ' + std::to_string(std::max<int>(record.values[i], 1));
  if (layout.timestamp) out += ' ' + std::to_string(record.timestamp);
  if (layout.status) out += ' ' + std::to_string(record.status);
  if (record.too_fast) out += " es";
  if (record.unplugged) out += " eg";
  return out + "\r\n\0"s;
}

}  // namespace merlin::cyberglove
