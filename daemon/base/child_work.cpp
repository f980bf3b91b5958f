#include "daemon/base/child_work.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/unique_fd.h"

namespace merlin {
namespace {

bool writeAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

std::string readAll(int fd) {
  std::string all;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t n = ::read(fd, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return all;
    all.append(block.data(), static_cast<std::size_t>(n));
  }
}

// Calls `work`, then writes to the pipe `to` one byte (0: success; otherwise 1 + the error code)
// and the result or the error's message.
[[noreturn]] void runChild(const std::function<Result<std::string>()>& work, int to,
                           std::chrono::seconds limit) {
  const auto seconds = static_cast<rlim_t>(limit.count());
  const rlimit cpu{seconds, seconds + 1}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int s : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) ::signal(s, SIG_DFL);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  const auto done = work();
  const char code = done ? '\0' : static_cast<char>(1 + static_cast<int>(done.error().code));
  const bool sent =
      writeAll(to, std::string_view(&code, 1)) && writeAll(to, done ? *done : done.error().what);
  ::_exit(sent ? 0 : 1);
}

}  // namespace

Result<std::string> inChild(const std::function<Result<std::string>()>& work,
                            const std::string& ended, std::chrono::seconds limit) {
  auto pipe = makePipe();
  if (!pipe) return pipe.error();
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) runChild(work, pipe->to.get(), limit);
  pipe->to.reset();
  std::string bytes = readAll(pipe->from.get());
  const int status = waitForChild(*child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || bytes.empty())
    return Error{Errc::kMalformed, ended};
  const int code = static_cast<unsigned char>(bytes[0]);
  bytes.erase(0, 1);
  if (code == 0) return bytes;
  return Error{static_cast<Errc>(code - 1), bytes};
}

}  // namespace merlin
