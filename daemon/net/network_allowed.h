// Whether this process may use network sockets: a service's sandbox may forbid them, and libzmq
// ends the process where it finds that out by itself.
#pragma once

#include "daemon/base/result.h"

namespace merlin::net {

// Opens a network socket and closes it. Errors: kUnsupported (forbidden, with the way out), kIo (no
// descriptor is left).
Result<Ok> networkAllowed();

}  // namespace merlin::net
