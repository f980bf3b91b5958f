#include "daemon/cli/import_child.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"

namespace merlin::cli {
namespace {

constexpr std::size_t kMostLine = 8192;

template <typename T>
T number(std::string_view text) {
  T value{};
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Removes the first word and the blank after it from `text`, and returns the word.
std::string_view word(std::string_view& text) {
  const std::size_t n = std::min(text.find(' '), text.size());
  const std::string_view first = text.substr(0, n);
  text.remove_prefix(std::min(n + 1, text.size()));
  return first;
}

Result<std::string> importProgram() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto program = self.parent_path() / "merlin-import";
  if (!error && ::access(program.c_str(), X_OK) == 0) return program.string();
  return Error{
      Errc::kUnsupported,
      fmt::format("{}: is not there; install the package merlin-import. In a build tree it is "
                  "built beside merlin if its libraries are installed (./dev build installs them)",
                  program.string())};
}

[[noreturn]] void execute(const std::vector<std::string>& arguments, int output) {
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::setpgid(0, 0);  // so that Ctrl-C reaches only merlin, which then ends this process
  ::dup2(output, STDOUT_FILENO);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDERR_FILENO);  // libraries print warnings there; faults are in the report
  std::vector<char*> argv;
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

void ImportReport::take(std::string_view bytes) {
  for (const char c : bytes) {
    if (c == '\n') {
      line(std::exchange(pending_, {}));
    } else if (pending_.size() < kMostLine) {
      pending_.push_back(c);
    }
  }
}

void ImportReport::line(std::string_view text) {
  const std::string_view what = word(text);
  if (what == "progress") {
    share_ = number<double>(word(text));
    items_ = number<std::uint64_t>(word(text));
  } else if (what == "pixels") {
    pixels_ = number<std::uint64_t>(text);
  } else if (what == "lacks" && lacks_.size() < 16) {
    lacks_.emplace_back(text);
  } else if (what == "note" && notes_.size() < 16) {
    notes_.emplace_back(text);
  } else if (what == "done") {
    const std::string name(word(text));
    if (name.find('/') == std::string::npos && !name.empty()) result_ = name;
    facts_ = text;
  } else if (what == "failed") {
    const int code = number<int>(word(text));
    const bool known = code >= 0 && code <= static_cast<int>(Errc::kNoMemory);
    result_ = Error{known ? static_cast<Errc>(code) : Errc::kIo, std::string(text)};
  }
}

Result<ImportChild> ImportChild::start(const std::vector<std::string>& arguments) {
  const auto program = importProgram();
  if (!program) return program.error();
  std::vector<std::string> all = {*program};
  all.insert(all.end(), arguments.begin(), arguments.end());
  auto pipe = makePipe();
  if (!pipe) return pipe.error();
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) execute(all, pipe->to.get());
  return ImportChild(*child, std::move(pipe->from));
}

ImportChild::ImportChild(ImportChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      output_(std::move(other.output_)),
      report_(std::move(other.report_)) {}

ImportChild::~ImportChild() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitForChild(pid_);
}

// Reads the bytes that have arrived from the process; returns false at the end of its output.
bool ImportChild::read() {
  std::array<char, 4096> bytes{};
  const ssize_t n = ::read(output_.get(), bytes.data(), bytes.size());
  if (n > 0) report_.take({bytes.data(), static_cast<std::size_t>(n)});
  return n > 0 || (n < 0 && errno == EINTR);
}

Result<std::string> ImportChild::ended() {
  const int status = waitForChild(std::exchange(pid_, -1));
  if (report_.result()) return *report_.result();
  if (WIFSIGNALED(status)) {
    return Error{Errc::kMalformed,
                 fmt::format("the import ended by signal {} ({}): the file is damaged, or it needs "
                             "more memory or time than is allowed",
                             WTERMSIG(status), ::strsignal(WTERMSIG(status)))};
  }
  return Error{Errc::kIo, fmt::format("merlin-import ended with status {} and gave no reason",
                                      WEXITSTATUS(status))};
}

Result<std::string> ImportChild::follow(int stop,
                                        const std::function<void(const ImportReport&)>& on_progress,
                                        Duration patience) {
  const SystemClock clock;
  Timestamp advanced = clock.now();
  for (double share = -1;;) {
    std::array<pollfd, 2> wait{{{output_.get(), POLLIN, 0}, {stop, POLLIN, 0}}};
    ::poll(wait.data(), wait.size(), 1000);
    if (wait[1].revents != 0)
      return Error{Errc::kClosed, "the import was stopped; nothing is left of it"};
    if (wait[0].revents != 0 && !read()) return ended();
    if (std::exchange(share, report_.share()) != report_.share()) {
      advanced = clock.now();
      on_progress(report_);
    }
    if (clock.now() - advanced > patience) {
      return Error{Errc::kTimeout,
                   fmt::format("the import made no progress for {:.0f} s and was ended",
                               toSeconds(patience))};
    }
  }
}

}  // namespace merlin::cli
