// Handles the signals that end or restart the processes of the roles page and alarms, and the
// watchdog interval of every role.
#pragma once

#include <functional>

#include "daemon/base/clock.h"

namespace merlin {

// Longest time for which a role waits for a signal before it does its periodic work.
inline constexpr Duration kSignalBeat = std::chrono::milliseconds(100);

// Returns the time between two watchdog pings: half of systemd's watchdog time; zero if there is no
// watchdog.
Duration watchdogInterval();

enum class Asked { kNothing, kStop, kStartAgain, kTest };

// Waits up to `wait` (less than 1 s) for a signal and returns what it asks for: kStop after SIGTERM
// or SIGINT, kStartAgain after SIGHUP if is_valid() returns true, kTest after SIGUSR1, otherwise
// kNothing. `is_valid` reads the configuration and logs its faults. REQUIRES: SIGTERM, SIGINT and
// SIGHUP are blocked; SIGUSR1 is blocked or ignored.
Asked askedBySignal(Duration wait, const std::function<bool()>& is_valid);

// Logs whether the process stops or starts again, and notifies systemd if it stops. systemd is not
// notified of a restart, because the same process continues.
void tellEnd(Asked asked);

}  // namespace merlin
