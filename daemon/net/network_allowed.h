// Checks whether this process may use network sockets: a service's sandbox may forbid them, and
// libzmq then aborts the process.
#pragma once

#include "daemon/base/result.h"

namespace merlin::net {

// Opens a network socket and closes it. Errors: kUnsupported (forbidden; the text says how to allow
// it), kIo (no descriptor is left).
Result<Ok> networkAllowed();

}  // namespace merlin::net
