// Runs long work in a child process, so that the parent can report its progress, end it, and clean
// up, however it ends.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <signal.h>

#include "daemon/base/result.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

struct WatchedWork {
  // Called in the child; reports its progress to the listener. May print.
  std::function<Result<Ok>(const ProgressListener&)> work;
  // Called in the parent ten times a second with the child's last report: its step and its share;
  // with an empty title before the first report.
  ProgressListener on_progress;
  std::uint64_t most_bytes = 0;  // limit for each file that the child writes
};

// Runs the work until it is done or `stop`, of stopSignals(), is readable. `mask`: the signal mask
// from before stopSignals(), for the child. Errors: those of the work; kClosed (`stop`); kIo (a
// signal ended the child). To be called while the process has one thread.
Result<Ok> runWatched(const WatchedWork& watched, int stop, const sigset_t& mask);

}  // namespace merlin::cli
