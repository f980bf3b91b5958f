// What ends the processes of merlind's roles beside the wall, or has them start again: page and
// alarms.
#pragma once

#include <functional>

#include "daemon/base/clock.h"

namespace merlin {

enum class Asked { kNothing, kStop, kStartAgain, kTest };

// Waits up to `wait` for a signal. SIGTERM and SIGINT: kStop. SIGHUP: kStartAgain if `is_valid`,
// which reads the configuration and says in the log what is wrong with it, returns true. SIGUSR1:
// kTest, where it is not ignored. REQUIRES: the first three are blocked, and the fourth where it is
// not ignored.
Asked askedBySignal(Duration wait, const std::function<bool()>& is_valid);

// Tells the log, and systemd unless the process starts again: to systemd it goes on then.
void tellEnd(Asked asked);

}  // namespace merlin
