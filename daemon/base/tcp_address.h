// TcpAddress: an address "tcp://HOST:PORT", by which settings name raw serial servers and other
// daemons.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace merlin {

struct TcpAddress {
  std::string host;  // a name, an IPv4 address, an IPv6 address without its brackets, or "*"
  std::string port;  // 1 to 65535, decimal
};

// Parses "tcp://HOST:PORT" or "tcp://[::1]:PORT"; nothing if the text is neither. Names of hosts
// are not looked up; a host of digits and dots alone must be an IPv4 address.
std::optional<TcpAddress> parseTcpAddress(std::string_view text);

}  // namespace merlin
