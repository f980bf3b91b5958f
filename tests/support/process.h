// Process: a real program, started by a test, with access to its output and exit status.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/eventually.h"

namespace merlin::test {

// Standard output and standard error go into one file, which output() reads. type() writes to
// standard input.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments,
                   const std::map<std::string, std::string>& environment = {}) {
    char name[] = "/tmp/merlin-output-XXXXXX";
    output_ = ::mkstemp(name);
    ::unlink(name);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    input_ = ends[1];
    pid_ = ::fork();
    if (pid_ != 0) {
      ::close(ends[0]);
      return;
    }
    ::dup2(ends[0], STDIN_FILENO);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(output_, STDOUT_FILENO);
    ::dup2(output_, STDERR_FILENO);
    for (const auto& [key, value] : environment) ::setenv(key.c_str(), value.c_str(), 1);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ~Process() {
    if (!status_) kill(SIGKILL);
    ::close(output_);
    ::close(input_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }

  // Writes `text` to its standard input.
  void type(const std::string& text) const {
    EXPECT_EQ(::write(input_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  // Its output so far.
  std::string output() const {
    std::string text;
    char buffer[4096];
    for (off_t at = 0;;) {
      const ssize_t n = ::pread(output_, buffer, sizeof buffer, at);
      if (n <= 0) return text;
      text.append(buffer, static_cast<std::size_t>(n));
      at += n;
    }
  }
  bool saysEventually(const std::string& text) {
    return eventually([&] { return output().find(text) != std::string::npos || ended(); }) &&
           output().find(text) != std::string::npos;
  }

  bool ended() {
    if (status_) return true;
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return true;
  }

  // Waits up to 300 s for the process to end. Returns its exit status, 128 + the signal's number,
  // or -1 if it does not end.
  int wait() {
    return eventually([&] { return ended(); }, std::chrono::seconds(300)) ? *status_ : -1;
  }

  int kill(int signal) {
    if (!ended()) ::kill(pid_, signal);
    return wait();
  }

 private:
  pid_t pid_ = -1;
  int output_ = -1, input_ = -1;
  std::optional<int> status_;
};

// Runs a program to its end; see Process::wait() for `status`.
struct Outcome {
  int status = -1;
  std::string output;
};
inline Outcome run(std::vector<std::string> arguments) {
  Process process(std::move(arguments));
  const int status = process.wait();
  return {status, process.output()};
}

}  // namespace merlin::test
