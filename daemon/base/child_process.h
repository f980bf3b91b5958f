// What every child process needs: a pipe to it, its start, and the wait for its end.
#pragma once

#include <sys/types.h>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

struct Pipe {
  UniqueFd from;  // what is written to `to` is read here
  UniqueFd to;
};

// Neither end is passed on by exec(). Errors: kIo (the process has no descriptors left).
Result<Pipe> makePipe();

// Calls fork(): returns 0 in the child, and the child's process id in the parent. Errors: kIo (the
// limit of processes is reached, or no memory is left). The child of a process with several threads
// may call only what signal handlers may, until it becomes another program.
Result<pid_t> startChild();

// Waits until `child` has ended, whatever signals arrive meanwhile, and returns its status as
// waitpid() gives it; 0 where somebody else has waited for it already.
int waitForChild(pid_t child);

}  // namespace merlin
