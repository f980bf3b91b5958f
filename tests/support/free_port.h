// Finds a free TCP port of this machine, for tests that link merlin::net.
#pragma once

#include "daemon/net/connection_server.h"

namespace merlin::test {

// Returns the number of a TCP port that the system assigned and that has been closed again; 0 if
// there is none.
inline int freePort() {
  const auto probe = net::listenTcp("127.0.0.1", 0);
  return probe ? net::portOf(probe->get()) : 0;
}

}  // namespace merlin::test
