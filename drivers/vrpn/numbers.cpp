#include "drivers/vrpn/numbers.h"

#include <charconv>

#include "drivers/port/vrpn_line.h"

namespace merlin::vrpn {

std::optional<int> parseNumber(std::string_view text, std::size_t end) {
  unsigned number = 0;
  const char* const last = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), last, number);
  if (parsed.ec != std::errc() || parsed.ptr != last || number >= end) return std::nullopt;
  return static_cast<int>(number);
}

std::optional<int> channelNumber(std::string_view text) { return parseNumber(text, kVrpnChannels); }

}  // namespace merlin::vrpn
