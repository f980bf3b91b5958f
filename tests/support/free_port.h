// A TCP port of this machine that nobody has. For tests that link merlin::net.
#pragma once

#include "daemon/net/connection_server.h"

namespace merlin::test {

// The system has just assigned it, and it was closed again. 0: there is none.
inline int freePort() {
  const auto probe = net::listenTcp("127.0.0.1", 0);
  return probe ? net::portOf(probe->get()) : 0;
}

}  // namespace merlin::test
