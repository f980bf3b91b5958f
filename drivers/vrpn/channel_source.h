// ChannelSource: which channel of an analog moves one of a ball's six axes. Pure.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace merlin::vrpn {

struct ChannelSource {
  int channel = -1;  // the server's number; -1: none
  int minus = -1;    // of the channel that pulls the other way; -1: none
  bool reversed = false;

  bool operator==(const ChannelSource&) const = default;
};

// For x, y, z and the rotations about them.
using ChannelSources = std::array<ChannelSource, 6>;

// Parses a form of kChannelForms; nothing if it is none.
std::optional<ChannelSource> parseChannelSource(std::string_view text);

// Parses the number of a button or a channel that is less than `end`; nothing if it is none.
std::optional<int> parseNumber(std::string_view text, std::size_t end);

}  // namespace merlin::vrpn
