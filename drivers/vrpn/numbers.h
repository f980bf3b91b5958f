// The channels of an analog, and numbers of buttons, as the configuration has them. Pure.
#pragma once

#include <optional>
#include <string_view>

namespace merlin::vrpn {

// Parses the number of a button or a channel that is less than `end`; nothing if it is none.
std::optional<int> parseNumber(std::string_view text, std::size_t end);

// The number of a channel, for an AxisSource.
std::optional<int> channelNumber(std::string_view text);

}  // namespace merlin::vrpn
