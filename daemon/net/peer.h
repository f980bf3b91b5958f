// Peer: who is at the other end of a connection, according to the kernel, not to the peer itself.
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace merlin::net {

// A local peer is identified by user and process, a TCP peer by its IPv4 address.
struct Peer {
  std::int64_t user = -1;     // uid; -1 over TCP
  std::int64_t process = -1;  // pid; -1 over TCP
  std::uint32_t address = 0;  // host byte order; 0 for a local socket
  auto operator<=>(const Peer&) const = default;
};

// Returns the peer of an accepted or connected socket. Values that are unknown have their defaults.
Peer peerOf(int fd);

// Returns the peer as text: "user 1000, process 4321" or "192.168.1.7".
std::string peerName(const Peer& peer);

}  // namespace merlin::net
