#include "daemon/serve/vrpn_protocol.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace merlin::serve {

VrpnFront readVrpn(std::string_view input) {
  VrpnFront front;
  if (input.size() < kVrpnHeaderLength) return front;
  const VrpnStart start = readVrpnStart(input);
  front.broken = start.bytes == 0 || start.bytes > kVrpnLongest;
  if (front.broken || input.size() < start.bytes) return front;
  front.message = VrpnMessage{start.header, input.substr(kVrpnHeaderLength, start.payload)};
  front.bytes = start.bytes;
  return front;
}

std::optional<VrpnCallback> readVrpnCallback(std::string_view datagram) {
  datagram = datagram.substr(0, datagram.find('\0'));
  const std::size_t blank = datagram.find(' ');
  if (blank == std::string_view::npos || blank == 0) return std::nullopt;
  const std::string_view host = datagram.substr(0, blank), number = datagram.substr(blank + 1);
  const bool plain = std::all_of(host.begin(), host.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.';
  });
  int port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  const bool whole = error == std::errc{} && end == number.data() + number.size();
  if (!plain || !whole || port < 1024 || port > 65535) return std::nullopt;
  return VrpnCallback{std::string(host), port};
}

}  // namespace merlin::serve
