// Runs long work in a child process, so that the parent can report the progress, end the work, and
// clean up however the work ends.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <signal.h>

#include "daemon/base/result.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

struct WatchedWork {
  // Called in the child process; reports its progress to the listener. May print.
  std::function<Result<Ok>(const ProgressListener&)> work;
  // Called in the parent process ten times a second with the title and share that the child has
  // reported last; the title is empty before the first report.
  ProgressListener on_progress;
  std::uint64_t most_bytes = 0;  // limit for each file that the child writes
};

// Runs the work until it is done or `stop` is readable. `stop`: the descriptor of stopSignals();
// `mask`: the signal mask from before stopSignals(), for the child. Errors: those of the work;
// kClosed (`stop`, or Ctrl-C ended the child); kIo (another signal ended the child). REQUIRES: the
// process has one thread.
Result<Ok> runWatched(const WatchedWork& watched, int stop, const sigset_t& mask);

}  // namespace merlin::cli
