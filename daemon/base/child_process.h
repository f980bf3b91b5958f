// Functions for child processes: make a pipe to one, start one, and wait for its end.
#pragma once

#include <sys/types.h>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

struct Pipe {
  UniqueFd from;  // the end that is read
  UniqueFd to;    // the end that is written
};

// Makes a pipe; exec() closes both ends. Errors: kIo (the process has no descriptors left).
Result<Pipe> makePipe();

// Calls fork(): returns 0 in the child, and the child's process id in the parent. Errors: kIo (the
// limit of processes is reached, or no memory is left). The child of a process with several threads
// may call only what signal handlers may, until it becomes another program.
Result<pid_t> startChild();

// Waits until `child` has ended, even if signals interrupt the wait, and returns its status as
// waitpid() gives it; 0 if `child` was waited for already.
int waitForChild(pid_t child);

}  // namespace merlin
