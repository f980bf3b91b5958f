#include "daemon/alarms/child_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"

namespace merlin::alarms {
namespace {

// Makes a file without a name that contains the text and is read from its beginning. Unlike a pipe
// it never blocks the writer.
Result<UniqueFd> fileOf(const std::string& text) {
  UniqueFd file(::memfd_create("event", MFD_CLOEXEC));
  const bool good =
      file.valid() &&
      ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::lseek(file.get(), 0, SEEK_SET) == 0;
  if (good) return file;
  return Error{Errc::kIo,
               fmt::format("cannot make a file for the event: {}", std::strerror(errno))};
}

// Runs the program in the child, which may only call functions that are safe in signal handlers.
// Resets all signals to their defaults. `failure`: the pipe into which the errno of execv() is
// written; if execv() succeeds, the pipe is closed.
[[noreturn]] void become(const std::vector<char*>& arguments, int input, int output, int failure,
                         pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  sigset_t none;
  ::sigemptyset(&none);
  for (int s = 1; s < NSIG; ++s) ::signal(s, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execv(arguments[0], arguments.data());
  const int why = errno;
  (void)!::write(failure, &why, sizeof why);
  ::_exit(127);
}

// Waits until the child runs the program (returns 0) or reports why it cannot (returns the errno).
int failureOf(const UniqueFd& end) {
  int why = 0;
  ssize_t got = 0;
  do got = ::read(end.get(), &why, sizeof why);
  while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(sizeof why) ? why : 0;
}

// Returns why the file cannot be executed, without reading its content; empty if it can.
std::string whyNoProgram(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || ::access(path.c_str(), X_OK) != 0)
    return std::strerror(errno);
  return S_ISREG(status.st_mode) ? "" : "it is not a file";
}

// Returns why the kernel cannot execute a file with this beginning; empty if it can. It can execute
// a script (#!) whose interpreter can be executed, and programs of other formats. A file that does
// not begin with #! but has a zero byte in its beginning is assumed to be such a program, because
// the kernel may know more formats than ELF (binfmt_misc).
std::string whyNoScript(std::string_view begin) {
  constexpr const char* kNone =
      "it is not a program; a script begins with a line such as #!/bin/sh";
  if (!begin.starts_with("#!")) return begin.find('\0') == std::string_view::npos ? kNone : "";
  begin = begin.substr(2, begin.find('\n') - 2);
  begin.remove_prefix(std::min(begin.find_first_not_of(" \t"), begin.size()));
  const std::string interpreter(begin.substr(0, begin.find_first_of(std::string_view(" \t\0", 3))));
  if (interpreter.empty()) return kNone;
  const std::string why = whyNoProgram(interpreter);
  if (why.empty()) return {};
  return fmt::format("its first line names the interpreter {}: {}", oneLine(interpreter), why);
}

std::string whyNotExecutable(const std::string& path) {
  constexpr std::size_t kReadByKernel = 256;
  std::string why = whyNoProgram(path);
  if (!why.empty()) return why;
  const auto begin = FileCopy::read(path, kReadByKernel);
  return begin ? whyNoScript(begin->text()) : "";  // a program need not be readable
}

Error cannotBeExecuted(const std::string& path, std::string_view why) {
  return {Errc::kNotFound, fmt::format("{}: cannot be executed: {}", path, why)};
}

}  // namespace

Result<Ok> checkProgram(const std::string& path) {
  const std::string why = whyNotExecutable(path);
  if (why.empty()) return Ok{};
  return cannotBeExecuted(path, why);
}

Result<ChildProgram> ChildProgram::start(const std::vector<std::string>& run,
                                         const std::string& input, Timestamp deadline) {
  const auto notStarted = [&](const Error& why) {
    return Error{why.code, fmt::format("{}: {}", run.front(), why.what)};
  };
  const auto file = fileOf(input);
  if (!file) return notStarted(file.error());
  std::vector<char*> arguments;
  for (const std::string& a : run) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  auto failures = makePipe(), output = makePipe();
  if (!failures) return notStarted(failures.error());
  if (!output) return notStarted(output.error());
  ::fcntl(output->from.get(), F_SETFL, O_NONBLOCK);
  const pid_t parent = ::getpid();
  const auto child = startChild();
  if (!child) return notStarted(child.error());
  if (*child == 0) become(arguments, file->get(), output->to.get(), failures->to.get(), parent);
  ::setpgid(*child, *child);  // in both processes: either may be first
  failures->to.reset();
  if (const int failure = failureOf(failures->from); failure != 0) {
    waitForChild(*child);
    const auto usable = checkProgram(run.front());  // its error says more than errno
    return usable ? cannotBeExecuted(run.front(), std::strerror(failure)) : usable.error();
  }
  return ChildProgram(*child, std::move(output->from), deadline);
}

ChildProgram::ChildProgram(ChildProgram&& other) noexcept { *this = std::move(other); }

ChildProgram& ChildProgram::operator=(ChildProgram&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(output_, other.output_);
  std::swap(deadline_, other.deadline_);
  std::swap(too_long_, other.too_long_);
  std::swap(kept_, other.kept_);
  std::swap(left_out_, other.left_out_);
  return *this;
}

ChildProgram::~ChildProgram() {
  if (pid_ < 0) return;
  kill();
  waitForChild(pid_);
}

void ChildProgram::kill() noexcept { ::kill(-pid_, SIGKILL); }

// Reads a limited amount at a time: a program that writes without end has to wait for the pipe.
void ChildProgram::readOutput() {
  constexpr int kMostReads = 16;
  std::array<char, 65536> bytes;  // NOLINT: filled by read
  for (int i = 0; i < kMostReads; ++i) {
    const ssize_t got = ::read(output_.get(), bytes.data(), bytes.size());
    if (got <= 0) return;
    const auto count = static_cast<std::size_t>(got);
    const std::size_t keep = std::min(count, kMostKept - kept_.size());
    kept_.append(bytes.data(), keep);
    left_out_ += count - keep;
  }
}

std::vector<std::string> ChildProgram::written() const {
  std::vector<std::string> lines;
  for (std::string_view rest = wholeCharacters(kept_); !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (end > 0) lines.push_back(oneLine(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (left_out_ > 0) lines.push_back(fmt::format("... and {} bytes more, left out", left_out_));
  return lines;
}

std::optional<std::string> ChildProgram::ended(Timestamp now) {
  if (pid_ < 0) return std::nullopt;
  readOutput();
  if (now >= deadline_ && !too_long_) {
    too_long_ = true;
    kill();
  }
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  kill();  // the processes that it left behind
  pid_ = -1;
  readOutput();
  if (too_long_) return "took longer than its time limit, and was ended";
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) return fmt::format("ended with status {}", WEXITSTATUS(status));
  return "";
}

}  // namespace merlin::alarms
