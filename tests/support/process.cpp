#include "tests/support/process.h"

#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace merlin::test {

Process::Process(std::vector<std::string> arguments,
                 const std::map<std::string, std::string>& environment) {
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

Process::~Process() {
  if (!status_) kill(SIGKILL);
  ::close(output_);
  ::close(input_);
}

void Process::type(const std::string& text) const {
  EXPECT_EQ(::write(input_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

std::string Process::output() const {
  std::string text;
  char buffer[4096];
  for (off_t at = 0;;) {
    const ssize_t n = ::pread(output_, buffer, sizeof buffer, at);
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
    at += n;
  }
}

bool Process::saysEventually(const std::string& text) {
  return eventually([&] { return output().find(text) != std::string::npos || ended(); }) &&
         output().find(text) != std::string::npos;
}

bool Process::ended() {
  if (status_) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

int Process::wait() {
  return eventually([&] { return ended(); }, std::chrono::seconds(300)) ? *status_ : -1;
}

int Process::kill(int signal) {
  if (!ended()) ::kill(pid_, signal);
  return wait();
}

Outcome run(std::vector<std::string> arguments) {
  Process process(std::move(arguments));
  const int status = process.wait();
  return {status, process.output()};
}

}  // namespace merlin::test
