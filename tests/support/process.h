// Process: a real program, started by a test, with access to its output and exit status.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <signal.h>
#include <sys/types.h>

#include "tests/support/eventually.h"

namespace merlin::test {

// A started program. Its standard output and standard error go into one file, which output() reads;
// type() writes to its standard input.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments,
                   const std::map<std::string, std::string>& environment = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }

  // Writes `text` to the program's standard input.
  void type(const std::string& text) const;

  // The program's output so far.
  std::string output() const;
  bool saysEventually(const std::string& text);

  bool ended();

  // Waits up to 300 s for the process to end. Returns its exit status, 128 + the signal's number,
  // or -1 if it does not end.
  int wait();

  int kill(int signal);

 private:
  pid_t pid_ = -1;
  int output_ = -1, input_ = -1;
  std::optional<int> status_;
};

// Result of a program that has ended; `status` is as returned by Process::wait().
struct Outcome {
  int status = -1;
  std::string output;
};
Outcome run(std::vector<std::string> arguments);

}  // namespace merlin::test
