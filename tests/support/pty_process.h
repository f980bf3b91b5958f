// PtyProcess: a real program on its own pseudo-terminal, whose screen a test reads.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/eventually.h"
#include "tests/support/terminal_screen.h"

namespace merlin::test {

class PtyProcess {
 public:
  PtyProcess(std::vector<std::string> arguments, int rows, int columns,
             const std::map<std::string, std::string>& environment = {})
      : screen_(rows, columns) {
    winsize size{};
    size.ws_row = static_cast<unsigned short>(rows);
    size.ws_col = static_cast<unsigned short>(columns);
    pid_ = ::forkpty(&master_, nullptr, nullptr, &size);
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::setenv("TERM", "xterm", 1);
    ::setenv("LC_ALL", "C.UTF-8", 1);
    for (const auto& [key, value] : environment) ::setenv(key.c_str(), value.c_str(), 1);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ~PtyProcess() {
    if (!ended()) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(master_);
  }
  PtyProcess(const PtyProcess&) = delete;
  PtyProcess& operator=(const PtyProcess&) = delete;

  // The terminal's content after the output so far.
  const TerminalScreen& screen() {
    readAll();
    return screen_;
  }
  // All bytes of output so far.
  const std::string& output() {
    readAll();
    return output_;
  }
  bool showsEventually(const std::string& part) {
    return eventually([&] { return screen().shows(part) || ended(); }) && screen().shows(part);
  }
  void type(const std::string& text) const {
    EXPECT_EQ(::write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  // Resizes the terminal, as when its window is resized: the program gets SIGWINCH.
  void resize(int rows, int columns) {
    readAll();
    screen_ = TerminalScreen(rows, columns);
    winsize size{};
    size.ws_row = static_cast<unsigned short>(rows);
    size.ws_col = static_cast<unsigned short>(columns);
    EXPECT_EQ(::ioctl(master_, TIOCSWINSZ, &size), 0);
  }
  int wait() {
    return eventually([&] { return readAll(), ended(); }) ? *status_ : -1;
  }
  bool ended() {
    if (status_) return true;
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return true;
  }
  pid_t pid() const { return pid_; }

 private:
  void readAll() {
    pollfd item{master_, POLLIN, 0};
    char bytes[4096];
    while (::poll(&item, 1, 0) > 0) {
      const ssize_t n = ::read(master_, bytes, sizeof bytes);
      if (n <= 0) return;  // the program has ended
      output_.append(bytes, static_cast<std::size_t>(n));
      screen_.feed({bytes, static_cast<std::size_t>(n)});
    }
  }

  TerminalScreen screen_;
  std::string output_;
  int master_ = -1;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace merlin::test
