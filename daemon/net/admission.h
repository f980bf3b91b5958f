// Who gets a place at a server, and who has to give one up for it. Pure.
//
// A server has a fixed number of places. A newcomer gets a free one. Where none is free, or its own
// peer (process of a local socket, address of a TCP one) already has its share, the place of a
// connection that does least with it is given to the newcomer: first one that has not yet said what
// the protocol opens with, then one of the user or address that holds the most places, then the one
// that has been idle for longest. A connection keeps its place while it is active, and for a short
// time while it is set up, but only against those who hold no fewer places: a newcomer whose user
// or address, or whose process, holds at least two places fewer than another gets one of the
// latter's in any case. So whoever holds places, busy or idle, or floods with connections, keeps
// out only those who hold as many; among the processes of one user that takes as many processes as
// there are places.
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
