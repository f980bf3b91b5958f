// ZAP, ZeroMQ's authentication protocol: who may connect to an encrypted socket, and what for.
// Pure.
//
// libzmq asks about each client that has completed CURVE's handshake with a request of several
// frames at inproc://zeromq.zap.01, and waits for the answer before any of the client's messages is
// delivered. Source: ZeroMQ RFC 27 (ZAP 1.0).
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace merlin::status {

// What a client's key allows.
enum class Grant { kNothing, kRead, kCommand };

// The keys of the clients of one encrypted socket.
struct Door {
  std::vector<std::string> readers;     // public keys (Z85) that may read
  std::vector<std::string> commanders;  // those that may also send commands

  // Returns what this key allows; kCommand if it is in both lists.
  Grant grantOf(const std::string& key) const;
};

// The doors by the domain (ZMQ_ZAP_DOMAIN) of their sockets, which may be empty.
using Doors = std::map<std::string, Door, std::less<>>;

// Returns the frames of the answer to a request. The status is 200, with userOf() of the key's
// grant as the client's user id, or 400 if the request is malformed, the mechanism is not CURVE,
// the domain is not one of `doors`, or the key is in none of its lists. `request`: version, request
// id, domain, address, identity, mechanism, and the client's key in binary (32 bytes).
std::vector<std::string> zapAnswer(std::span<const std::string> request, const Doors& doors);

// Convert a grant to the user id that libzmq attaches to each message of the client, and back:
// "read" or "command"; empty for kNothing. Any other user id grants kNothing.
std::string userOf(Grant grant);
Grant grantOfUser(std::string_view user);

}  // namespace merlin::status
