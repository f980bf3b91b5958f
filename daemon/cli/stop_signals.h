// The signals that end a long-running subcommand, as a descriptor to wait on.
#pragma once

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>

#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// Blocks SIGTERM, SIGINT and SIGHUP, and returns a signalfd that becomes readable when one of them
// arrives.
inline UniqueFd stopSignals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&set, s);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  return UniqueFd(::signalfd(-1, &set, SFD_CLOEXEC));
}

// Returns whether one of the signals of stopSignals() is pending; does not wait. `stop`: the
// descriptor of stopSignals().
inline bool stopArrived(int stop) {
  pollfd waiting{stop, POLLIN, 0};
  return ::poll(&waiting, 1, 0) > 0;
}

}  // namespace merlin::cli
