// What ends the processes of merlind's roles beside the wall: page and alarms.
#pragma once

#include "daemon/base/clock.h"

namespace merlin {

// Waits up to `wait` for a signal; true for SIGTERM and SIGINT. SIGHUP is ignored with a line in
// the log that names `role`, since these processes read a changed configuration when they are
// restarted. REQUIRES: the three are blocked.
bool stopAsked(Duration wait, const char* role);

}  // namespace merlin
