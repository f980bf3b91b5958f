// Parses the numbers of channels and buttons in the configuration. Pure.
#pragma once

#include <optional>
#include <string_view>

namespace merlin::vrpn {

// Parses the number of a button or a channel, which must be less than `end`; nothing if it is
// invalid.
std::optional<int> parseNumber(std::string_view text, std::size_t end);

// The number of a channel, for an AxisSource.
std::optional<int> channelNumber(std::string_view text);

}  // namespace merlin::vrpn
