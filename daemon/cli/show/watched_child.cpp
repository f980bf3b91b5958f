#include "daemon/cli/show/watched_child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {
namespace {

constexpr int kLook_ms = 100;

void sendAll(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(to, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

// Does the work in the child process, which sends lines "SHARE TITLE" through the pipe `to`. At the
// end it sends a zero byte and, only after an error, one byte (1 + code of the error) and the text
// of the error.
[[noreturn]] void workInChild(const WatchedWork& watched, int to, const sigset_t& mask) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::sigprocmask(SIG_SETMASK, &mask, nullptr);
  ::signal(SIGXFSZ, SIG_IGN);  // so that writing beyond the limit fails with an error
  rlimit size{};
  ::getrlimit(RLIMIT_FSIZE, &size);
  size.rlim_cur = std::min<rlim_t>(watched.most_bytes, size.rlim_max);
  ::setrlimit(RLIMIT_FSIZE, &size);
  const SystemClock clock;
  Timestamp told{};
  const auto done = watched.work([&](const std::string& title, double share) {
    const Timestamp now = clock.now();
    if (now - told < std::chrono::milliseconds(kLook_ms / 2)) return;
    told = now;
    sendAll(to, fmt::format("{:.3f} {}\n", share, title));
  });
  std::string end(1, '\0');
  if (!done) end += static_cast<char>(1 + static_cast<int>(done.error().code)) + done.error().what;
  sendAll(to, end);
  std::fflush(nullptr);
  ::_exit(0);
}

// Parses what the child sends.
class Told {
 public:
  explicit Told(const ProgressListener& listener) : listener_(listener) {}

  // Reads the bytes that have arrived; returns false when the child has closed the pipe.
  bool read(int from) {
    std::array<char, 4096> bytes{};
    const ssize_t n = ::read(from, bytes.data(), bytes.size());
    if (n > 0) take({bytes.data(), static_cast<std::size_t>(n)});
    return n > 0 || (n < 0 && errno == EINTR);
  }
  void report() const { listener_(title_, share_); }

  // Returns the result of the work; nothing if the child has ended before the work was done.
  std::optional<Result<Ok>> result() const {
    if (!ended_) return std::nullopt;
    if (line_.empty()) return Result<Ok>(Ok{});
    return Result<Ok>(
        Error{static_cast<Errc>(static_cast<unsigned char>(line_[0]) - 1), line_.substr(1)});
  }

 private:
  void take(std::string_view bytes) {
    for (const char c : bytes) {
      if (ended_ || (c != '\n' && c != '\0')) {
        line_ += c;
        continue;
      }
      const std::size_t blank = line_.find(' ');
      if (c == '\n' && blank != std::string::npos) {
        std::from_chars(line_.data(), line_.data() + blank, share_);
        title_ = line_.substr(blank + 1);
      }
      ended_ = c == '\0';
      line_.clear();
    }
  }

  const ProgressListener& listener_;
  std::string line_, title_;
  double share_ = 0;
  bool ended_ = false;
};

// Sends SIGTERM to the child, which can then end its own child processes; kills it if it still runs
// after two seconds.
void endChild(pid_t child, int from, Told& told) {
  ::kill(child, SIGTERM);
  const SystemClock clock;
  const Timestamp until = clock.now() + std::chrono::seconds(2);
  pollfd item{from, POLLIN, 0};
  while (clock.now() < until) {
    if (::poll(&item, 1, kLook_ms) > 0 && !told.read(from)) return;
  }
  ::kill(child, SIGKILL);
}

// Passes the child's reports on until it closes the pipe, and returns true; returns false if `stop`
// becomes readable before.
bool follow(int from, int stop, Told& told) {
  const SystemClock clock;
  Timestamp looked{};
  for (;;) {
    std::array<pollfd, 2> items{pollfd{from, POLLIN, 0}, pollfd{stop, POLLIN, 0}};
    ::poll(items.data(), items.size(), kLook_ms);
    if (items[1].revents != 0) return false;
    if (items[0].revents != 0 && !told.read(from)) return true;
    if (clock.now() - looked < std::chrono::milliseconds(kLook_ms)) continue;
    looked = clock.now();
    told.report();
  }
}

}  // namespace

Result<Ok> runWatched(const WatchedWork& watched, int stop, const sigset_t& mask) {
  auto pipe = makePipe();
  if (!pipe) return pipe.error();
  std::fflush(nullptr);  // otherwise the child would write the buffered output a second time
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) workInChild(watched, pipe->to.get(), mask);
  pipe->to.reset();
  Told told(watched.on_progress);
  const bool finished = follow(pipe->from.get(), stop, told);
  if (!finished) endChild(*child, pipe->from.get(), told);
  const int status = waitForChild(*child);
  if (!finished) return Error{Errc::kClosed, "interrupted; nothing is left behind"};
  if (const auto result = told.result()) return *result;
  // Ctrl-C also reaches the child, and may end it before this process notices the signal.
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP)
    return Error{Errc::kClosed, "interrupted; nothing is left behind"};
  return Error{Errc::kIo,
               fmt::format("the import ended by signal {} ({}): it may need more memory than there "
                           "is (--memory)",
                           signal, ::strsignal(signal))};
}

}  // namespace merlin::cli
