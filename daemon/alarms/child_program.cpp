#include "daemon/alarms/child_program.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace merlin::alarms {
namespace {

// A file without a name, read from its beginning: unlike a pipe it never keeps the writer waiting.
Result<UniqueFd> fileOf(const std::string& text) {
  UniqueFd file(::memfd_create("event", MFD_CLOEXEC));
  const bool good =
      file.valid() &&
      ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::lseek(file.get(), 0, SEEK_SET) == 0;
  if (good) return file;
  return Error{Errc::kIo, fmt::format("the event's file: {}", std::strerror(errno))};
}

// In the child, which may only call what signal handlers may: our signals are not its.
[[noreturn]] void become(const std::vector<char*>& arguments, int input, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  sigset_t none;
  ::sigemptyset(&none);
  for (int s = 1; s < NSIG; ++s) ::signal(s, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(input, STDIN_FILENO);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

}  // namespace

Result<Ok> checkProgram(const std::string& path) {
  struct stat status {};
  const char* why = nullptr;
  if (::stat(path.c_str(), &status) != 0 || ::access(path.c_str(), X_OK) != 0)
    why = std::strerror(errno);
  else if (!S_ISREG(status.st_mode))
    why = "it is not a file";
  if (!why) return Ok{};
  return Error{Errc::kNotFound, fmt::format("{}: cannot be executed: {}", path, why)};
}

Result<ChildProgram> ChildProgram::start(const std::vector<std::string>& run,
                                         const std::string& input, Timestamp deadline) {
  if (const auto usable = checkProgram(run.front()); !usable) return usable.error();
  const auto file = fileOf(input);
  if (!file) return file.error();
  std::vector<char*> arguments;
  for (const std::string& a : run) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) become(arguments, file->get(), parent);
  if (pid < 0) return Error{Errc::kIo, fmt::format("fork: {}", std::strerror(errno))};
  ::setpgid(pid, pid);  // here too: whoever comes first
  return ChildProgram(pid, deadline);
}

ChildProgram::ChildProgram(ChildProgram&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), deadline_(other.deadline_), too_long_(other.too_long_) {}

ChildProgram& ChildProgram::operator=(ChildProgram&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(deadline_, other.deadline_);
  std::swap(too_long_, other.too_long_);
  return *this;
}

ChildProgram::~ChildProgram() {
  if (pid_ < 0) return;
  kill();
  ::waitpid(pid_, nullptr, 0);
}

void ChildProgram::kill() noexcept { ::kill(-pid_, SIGKILL); }

std::optional<std::string> ChildProgram::ended(Timestamp now) {
  if (pid_ < 0) return std::nullopt;
  if (now >= deadline_ && !too_long_) {
    too_long_ = true;
    kill();
  }
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  kill();  // what it left behind
  pid_ = -1;
  if (too_long_) return "took longer than its time limit, and was ended";
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) return fmt::format("ended with status {}", WEXITSTATUS(status));
  return "";
}

}  // namespace merlin::alarms
