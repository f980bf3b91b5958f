#include "daemon/base/child_process.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace merlin {

Result<Pipe> makePipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return Error{Errc::kIo,
                 fmt::format("a pipe to a child process cannot be made: {}", std::strerror(errno))};
  return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

Result<pid_t> startChild() {
  const pid_t child = ::fork();
  if (child < 0)
    return Error{Errc::kIo,
                 fmt::format("a child process cannot be started: {}{}", std::strerror(errno),
                             errno == EAGAIN ? " (this user or this machine has as many "
                                               "processes as its limit allows)"
                                             : "")};
  return child;
}

int waitForChild(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace merlin
