// Who gets a place at a server, and who has to give one up for it. Pure.
//
// A server has a fixed number of places. A newcomer gets a free one. Where none is free, or its own
// peer (process of a local socket, address of a TCP one) already has its share, the place of a
// connection that does least with it is given to the newcomer: first one that has not yet said what
// the protocol opens with, then one of the user or address that holds the most places, then the one
// that has been idle for longest. So nobody who only holds places can keep others out. A connection
// keeps its place for a short time in any case, so that a flood of newcomers cannot push out one
// that is just being set up: then the newcomer is refused.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "daemon/net/peer.h"

namespace merlin::net {

struct Places {
  std::size_t all = 32;       // connections of the server
  std::size_t per_peer = 16;  // of one process or one address
  // Time for which a connection keeps its place: while it opens, and after it was last active.
  Duration opening = std::chrono::milliseconds(250);
  Duration idle = std::chrono::seconds(1);
};

struct Occupant {
  Peer peer;
  Timestamp since{};         // accepted
  Timestamp active{};        // bytes last went either way
  bool established = false;  // has said what the protocol opens with
};

struct Decision {
  enum class Kind { kAdmit, kReplace, kRefuse };
  Kind kind = Kind::kAdmit;
  std::size_t victim = 0;  // of kReplace: which occupant goes
};

// O(n^2) in the number of occupants. Reentrant.
Decision decide(std::span<const Occupant> occupants, const Peer& newcomer, const Places& places,
                Timestamp now);

}  // namespace merlin::net
