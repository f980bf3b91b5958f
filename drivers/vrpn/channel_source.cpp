#include "drivers/vrpn/channel_source.h"

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

std::optional<ChannelSource> parseChannelSource(std::string_view text) {
  if (text == "none") return ChannelSource{};
  ChannelSource source;
  source.reversed = text.starts_with('-');
  if (source.reversed) text.remove_prefix(1);
  const auto between = text.find('-');
  const auto first = parseNumber(text.substr(0, between), kVrpnChannels);
  if (!first) return std::nullopt;
  source.channel = *first;
  if (between == std::string_view::npos) return source;
  const auto second = parseNumber(text.substr(between + 1), kVrpnChannels);
  if (!second || source.reversed || *second == *first) return std::nullopt;
  source.minus = *second;
  return source;
}

}  // namespace merlin::vrpn
