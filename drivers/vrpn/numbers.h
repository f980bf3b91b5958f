// Parses the numbers of channels and buttons in the configuration. Pure.
#pragma once

#include <optional>
#include <string_view>

namespace merlin::vrpn {

// Parses the number of a button or a channel, which must be less than `end`; returns nothing if the
// text is invalid.
std::optional<int> parseNumber(std::string_view text, std::size_t end);

// Parses the number of a channel, 0 to 127, for parseAxisSource(); returns nothing if the text is
// invalid.
std::optional<int> channelNumber(std::string_view text);

}  // namespace merlin::vrpn
