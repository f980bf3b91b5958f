// Parts of the VRPN protocol that only a server needs: clients' messages, and requests by UDP.
// drivers/port/vrpn_line describes the wire format. No I/O, no clock.
//
// Source: vrpn_Connection.C; README.md beside this.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/port/vrpn_line.h"

namespace merlin::serve {

// The longest message that is accepted from a client, including header and padding.
inline constexpr std::size_t kVrpnLongest = 8192;

struct VrpnMessage {
  VrpnHeader header;
  std::string_view payload;  // part of the input
};

// The message at the front of the input, as readVrpn() finds it. `message`: nothing if it is not
// complete yet or invalid.
struct VrpnFront {
  std::optional<VrpnMessage> message;
  std::size_t bytes = 0;  // length of the message in the input
  bool broken = false;    // invalid length: the connection must be closed
};
VrpnFront readVrpn(std::string_view input);

// Parses a UDP datagram, "127.0.0.1 59207" + NUL, by which a client asks us to connect to it.
// Nothing if it is malformed, the port is below 1024, or the host has characters other than
// letters, digits and dots.
struct VrpnCallback {
  std::string host;
  int port;
};
std::optional<VrpnCallback> readVrpnCallback(std::string_view datagram);

}  // namespace merlin::serve
