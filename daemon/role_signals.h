// The signals that end or restart the processes of the roles page and alarms, and the watchdog of
// every role.
#pragma once

#include <functional>

#include "daemon/base/clock.h"

namespace merlin {

// How long a role waits for a signal before it looks after the rest of its work.
inline constexpr Duration kSignalBeat = std::chrono::milliseconds(100);

// Half of systemd's watchdog time; zero if there is no watchdog.
Duration watchdogInterval();

enum class Asked { kNothing, kStop, kStartAgain, kTest };

// Waits up to `wait` for a signal. SIGTERM and SIGINT: kStop. SIGHUP: kStartAgain if `is_valid`,
// which reads the configuration and says in the log what is wrong with it, returns true. SIGUSR1:
// kTest, where it is not ignored. REQUIRES: the first three are blocked, and the fourth where it is
// not ignored.
Asked askedBySignal(Duration wait, const std::function<bool()>& is_valid);

// Reports the end to the log, and to systemd unless the process starts again, because to systemd it
// then goes on.
void tellEnd(Asked asked);

}  // namespace merlin
