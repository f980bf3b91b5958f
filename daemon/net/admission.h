// Admission: decides which connections get the places of a server. Pure.
//
// A server has a fixed number of places, one for each connection. A new connection gets a free
// place. If none is free, or if its peer (process of a local socket, address of a TCP one) already
// has its share, it replaces the least useful connection: first one that has not completed the
// handshake, then one of the user or address that holds most places, then the one that has been
// idle longest. A connection cannot be replaced while it is active, or for a short time after it
// was accepted. Exception: if the new connection's user or address, or its process, holds at least
// two places fewer than another, it always gets one of the other's places. So a client that holds
// many places (busy or idle) or floods the server with connections can exclude only peers that hold
// as many; to exclude processes of its own user it needs as many processes as there are places.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "daemon/net/peer.h"

namespace merlin::net {

struct Places {
  std::size_t all = 32;       // maximum number of connections of the server
  std::size_t per_peer = 16;  // maximum number for one process or one address
  // Times for which a connection cannot be replaced: `opening` after it was accepted, if it has not
  // completed the handshake; otherwise `idle` after it was last active.
  Duration opening = std::chrono::milliseconds(250);
  Duration idle = std::chrono::seconds(1);
};

struct Occupant {
  Peer peer;
  Timestamp since{};         // when it was accepted
  Timestamp active{};        // when it was last read or written
  bool established = false;  // whether it has completed the handshake
};

struct Decision {
  enum class Kind { kAdmit, kReplace, kRefuse };
  Kind kind = Kind::kAdmit;
  std::size_t victim = 0;  // for kReplace: index of the occupant to close
};

// Decides whether a new connection, `newcomer`, gets a place, and whose. O(n^2) in the number of
// occupants. Reentrant.
Decision decide(std::span<const Occupant> occupants, const Peer& newcomer, const Places& places,
                Timestamp now);

}  // namespace merlin::net
